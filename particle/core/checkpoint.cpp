#include "particle/core/checkpoint.hpp"

#include "particle/core/leapfrog.hpp"
#include "scene/build_info.hpp"
#include "scene/safe_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace concord::particle {
namespace {

/// The first lines in which two texts differ; the texts themselves if they are single lines.
std::pair<std::string, std::string> first_difference(const std::string& a,
                                                     const std::string& b) {
  std::size_t begin = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()) && a[i] == b[i]; ++i)
    if (a[i] == '\n') begin = i + 1;
  const auto line = [&](const std::string& text) {
    const std::string found = text.substr(begin, text.find('\n', begin) - begin);
    return found.empty() ? std::string("nothing") : found;
  };
  return {line(a), line(b)};
}

std::string program_and_processor() {
  const scene::BuildInfo& build = scene::build_info();
  return fmt::format("{} {} {} {} {}", build.version, build.commit, build.compiler, build.flags,
                     scene::simd_name());
}

}  // namespace

Checkpoints::Checkpoints(const scene::Keeping& keeping, std::function<RunFacts()> facts)
    : m_keeping(keeping), m_facts(std::move(facts)) {}

bool Checkpoints::due() const {
  const double passed = std::chrono::duration<double>(Clock::now() - m_last).count();
  return m_keeping.interval == 0 || passed >= std::max(m_keeping.interval, 50 * m_cost);
}

/// Throws InputError for facts that are not those of the checkpoint.
void Checkpoints::keep_facts(scene::Checkpoint& state) {
  std::string found, saved;
  for (const auto& [name, now] : m_facts()) {
    const std::string item = "fact." + name;
    std::string value = now;
    if (!state.restores() || state.has(item))
      state.item(item, value);
    else
      value.clear();
    if (value == now) continue;
    const auto [mine, its] = first_difference(now, value);
    found += fmt::format("{}{}: {}", found.empty() ? "" : "; ", name, mine);
    saved += fmt::format("{}{}: {}", saved.empty() ? "" : "; ", name, its);
  }
  if (!found.empty())
    throw InputError({state.file().string()}, "resume", found,
                     "what the run was begun with (" + saved + ")");
}

void Checkpoints::keep_past(scene::Checkpoint& state) {
  const std::string here = program_and_processor();
  std::string program = here;
  state.item("program", program);
  state.item("elsewhere", m_elsewhere);
  m_elsewhere = m_elsewhere || program != here;
}

void Checkpoints::save(const Items& items) {
  const auto begin = Clock::now();
  scene::Checkpoint state = scene::Checkpoint::to(m_keeping.file);
  state.item("request", m_keeping.request);
  keep_facts(state);
  keep_past(state);
  items(state);
  state.finish();
  m_last = Clock::now();
  m_cost = std::chrono::duration<double>(m_last - begin).count();
}

void Checkpoints::restore(const Items& items) {
  scene::Checkpoint state = scene::Checkpoint::from(m_keeping.file);
  keep_facts(state);
  keep_past(state);
  items(state);
  m_last = Clock::now();
}

namespace {

/// Of a record: every bond has ends a < b, every simplex went once, times never go back.
bool possible(const FractureRecord& record, const Body& body) {
  double t = before_start;
  for (const BrokenBond& bond : record.broken) {
    if (bond.a < 0 || bond.a >= bond.b || bond.b >= body.n || !(bond.t >= t)) return false;
    t = bond.t;
  }
  t = before_start;
  std::vector<char> gone(body.triangulation.size(), 0);
  for (const DeadSimplex& dead : record.dead) {
    if (dead.simplex < 0 || static_cast<std::size_t>(dead.simplex) >= gone.size() ||
        gone[dead.simplex] != 0 || !(dead.t >= t))
      return false;
    gone[dead.simplex] = 1;
    t = dead.t;
  }
  return true;
}

}  // namespace

void keep(FractureRecord& record, scene::Checkpoint& state, const Body& body) {
  std::vector<double> t_broken, t_dead;
  std::vector<Index> a, b, dead;
  for (const BrokenBond& bond : record.broken)
    t_broken.push_back(bond.t), a.push_back(bond.a), b.push_back(bond.b);
  for (const DeadSimplex& d : record.dead) t_dead.push_back(d.t), dead.push_back(d.simplex);
  state.item("record.broken_t", t_broken);
  state.item("record.broken_a", a);
  state.item("record.broken_b", b);
  state.item("record.dead_t", t_dead);
  state.item("record.dead", dead);
  state.item("record.released", record.released);
  if (!state.restores()) return;
  state.require(a.size() == t_broken.size() && b.size() == a.size() &&
                    dead.size() == t_dead.size(),
                "record", "lists that do not fit together");
  record.broken.clear();
  for (std::size_t k = 0; k < t_broken.size(); ++k)
    record.broken.push_back({t_broken[k], a[k], b[k]});
  record.dead.clear();
  for (std::size_t k = 0; k < t_dead.size(); ++k) record.dead.push_back({t_dead[k], dead[k]});
  state.require(possible(record, body), "record", "bonds or simplices that the body has not");
}

void ForceModel::keep(scene::Checkpoint& state) { m_constitution.keep(state); }

/// Between steps; the trial states are made anew by the next forces, but for particles that
/// have never been strained, whose committed and trial states are both those of the start.
void PlasticHistory::keep(scene::Checkpoint& state) {
  for (std::size_t k = 0; k < m_old.size(); ++k)
    state.fixed(fmt::format("plastic.{}", k), m_old[k]);
  if (!state.restores()) return;
  m_new = m_old;
  m_has_trial = false;
}

void ExternalWork::keep(scene::Checkpoint& state) {
  m_u.resize(m_dofs.size());
  m_force.resize(m_dofs.size());
  m_start_u.resize(m_constant.size());
  state.item("work.done", m_work);
  state.fixed("work.u", m_u);
  state.fixed("work.force", m_force);
  state.fixed("work.start_u", m_start_u);
}

void Dissipation::keep(scene::Checkpoint& state) { state.item("dissipation.done", m_work); }

void Recorder::Account::keep(scene::Checkpoint& state) {
  state.item("account.any", any);
  for (auto [name, b] : {std::pair{"first", &first}, std::pair{"last", &last}}) {
    const auto item = [&, of = std::string(name)](const char* what, auto& value) {
      state.item("account." + of + "." + what, value);
    };
    item("kinetic", b->kinetic), item("internal", b->internal), item("plastic", b->plastic);
    item("stabilisation", b->stabilisation), item("dissipation", b->dissipation);
    item("released", b->released), item("external_work", b->external_work);
    item("linear", b->linear), item("angular", b->angular);
    item("linear_scale", b->linear_scale), item("angular_scale", b->angular_scale);
  }
  state.item("account.largest_energy", largest_energy);
  state.item("account.largest_work", largest_work);
  state.item("account.energy_change", energy_change);
  state.item("account.linear_change", linear_change);
  state.item("account.angular_change", angular_change);
  state.item("account.linear_scale", linear_scale);
  state.item("account.angular_scale", angular_scale);
  state.item("account.share", share);
  state.item("account.share_max", share_max);
  state.item("account.checkerboard", checkerboard);
  state.item("account.checkerboard_max", checkerboard_max);
  state.item("account.nonaffine_sum", nonaffine_sum);
  state.item("account.energy_sum", energy_sum);
  crack_toll.keep(state);
}

/// History and frames so far are on the disk, also those that are new since the last time; the
/// times of the frames.
std::vector<double> Recorder::safe_files() {
  std::vector<double> times;
  for (const auto& [name, time] : m_frames) times.push_back(time);
  scene::bring_to_disk(history_file());
  for (std::size_t k = m_frame_digests.size(); k < m_frames.size(); ++k) {
    scene::bring_to_disk(m_folder / m_frames[k].first);
    m_frame_digests.push_back(scene::digest_of(m_folder / m_frames[k].first));
  }
  scene::bring_to_disk(m_folder);
  return times;
}

/// What the cracks measure follows from the model's record alone.
void Recorder::keep(scene::Checkpoint& state) {
  m_account.keep(state);
  if (m_folder.empty()) return;
  std::vector<double> times;
  std::uint64_t bytes = m_history_bytes, digest = 0;
  if (!state.restores()) {
    times = safe_files();
    digest = scene::digest_of(history_file(), bytes);
  }
  state.item("recorder.history_bytes", bytes);
  state.item("recorder.history_digest", digest);
  state.item("recorder.frame_times", times);
  state.item("recorder.frame_digests", m_frame_digests);
  if (!state.restores()) return;
  state.require(times.size() == m_frame_digests.size(), "recorder",
                "lists that do not fit together");
  if (m_write_frames) m_frames = scene::kept_frames(m_folder, times, m_frame_digests);
  m_history = scene::continue_history(history_file(), columns(), bytes, digest);
  m_history_bytes = bytes;
  if (m_write_frames) scene::end_frames(m_folder, m_frames);
}

void Leapfrog::keep(scene::Checkpoint& state, Recorder& recorder, LeapfrogOutcome& outcome) {
  state.fixed("u", m_u);
  state.fixed("v", m_v);
  state.fixed("f", m_f);
  state.item("t", m_t);
  state.item("dt_last", m_dt_last);
  state.item("dt", m_dt);
  state.item("gradient", m_gradient);
  state.item("dead_at_estimate", m_dead);
  state.item("row_at", m_row_at);
  state.item("frame_at", m_frame_at);
  state.item("row_due", m_row_due);
  state.item("frame_due", m_frame_due);
  state.item("next_row", m_next_row);
  state.item("next_frame", m_next_frame);
  state.item("outcome.steps", outcome.steps);
  state.item("outcome.dt", outcome.dt);
  state.item("outcome.t", outcome.t);
  state.item("outcome.loop_s", outcome.loop_s);
  state.item("outcome.settled", outcome.settled);
  state.item("outcome.particle_steps", outcome.particle_steps);
  state.item("outcome.resumed_at", outcome.resumed_at);
  state.require(
      std::isfinite(m_t) && m_t >= 0 && m_dt >= 0 && outcome.steps >= 0, "t",
      fmt::format("{} s after {} steps, with steps up to {} s", m_t, outcome.steps, m_dt));
  m_work.keep(state);
  m_dissipation.keep(state);
  m_model.keep(state);
  recorder.keep(state);  // the last, because it changes files
  if (state.restores()) outcome.resumed_at.push_back(outcome.steps);
}

void Leapfrog::save(const LeapfrogOptions& options, Recorder& recorder,
                    LeapfrogOutcome& outcome) {
  if (options.checkpoints == nullptr) return;
  options.checkpoints->save([&](scene::Checkpoint& state) { keep(state, recorder, outcome); });
}

/// The state is good, it could not be written down. The run goes on from it once there is
/// space, where the checkpoint itself finds room; else from an earlier one.
void Leapfrog::save_unwritten(const LeapfrogOptions& options, Recorder& recorder,
                              LeapfrogOutcome& outcome) {
  if (!m_row_due && !m_frame_due) return;
  try {
    save(options, recorder, outcome);
  } catch (const scene::OutputError&) {  // the first one is told
  }
}

}  // namespace concord::particle
