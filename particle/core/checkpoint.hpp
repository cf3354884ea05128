#pragma once
// Checkpoints of explicit runs: when they are written, and how it is known that one belongs to
// the run that asks for it. What is in them: checkpoint.cpp, and ForceModel::keep of models.

#include "particle/core/body.hpp"
#include "particle/core/fracturing.hpp"
#include "scene/checkpoint.hpp"

#include <chrono>
#include <functional>
#include <utility>

namespace concord::particle {

/// What has broken in a body, saved or restored. Throws InputError for what cannot have broken
/// in it.
void keep(FractureRecord& record, scene::Checkpoint& state, const Body& body);

/// Everything that decides the bits of a run, by name, as text; not the number of threads.
using RunFacts = std::vector<std::pair<std::string, std::string>>;

class Checkpoints {
 public:
  /// `facts` is asked when a checkpoint is saved or restored, not before.
  Checkpoints(const scene::Keeping& keeping, std::function<RunFacts()> facts);

  bool resumes() const { return m_keeping.resume; }
  /// Whether enough wall time has gone by since the last one: the interval asked for, and fifty
  /// times what the last one took, so that all of them take at most 2 % of a run. Always with
  /// an interval of 0.
  bool due() const;

  using Items = std::function<void(scene::Checkpoint&)>;
  /// Saves what `items` lists. Throws OutputError; the checkpoint that was there then stays.
  void save(const Items& items);
  /// Restores the same. Throws InputError, with all facts that differ.
  void restore(const Items& items);

  /// Whether another program or processor did some of the run: last bits may then differ.
  bool elsewhere() const { return m_elsewhere; }

 private:
  using Clock = std::chrono::steady_clock;
  void keep_facts(scene::Checkpoint& state);
  void keep_past(scene::Checkpoint& state);

  scene::Keeping m_keeping;
  std::function<RunFacts()> m_facts;
  Clock::time_point m_last = Clock::now();
  double m_cost = 0;  ///< of the last one [s]
  bool m_elsewhere = false;
};

}  // namespace concord::particle
