#pragma once
// The state of a run on disk, so that a run that was stopped can go on with the same bits.

#include "scene/method.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace concord::scene {

/// A state in an HDF5 file: named columns and numbers, saved or restored bit for bit. One list
/// of items serves both ways, so that none can be forgotten on one of them:
///
///     void Part::keep(Checkpoint& state) {
///       state.item("part.work", m_work);
///       state.fixed("part.u", m_u);
///     }
///
/// Names are unique in the file, and begin with the part that owns them. Whatever is asked for
/// and is not there, or has another size than expected, throws InputError with the file's name.
/// A checksum over all of the file, names and sizes included, is compared before anything is
/// read.
class Checkpoint {
 public:
  /// Begins to save, in memory; finish() writes `file`.
  static Checkpoint to(const std::filesystem::path& file);
  /// Opens a state that was saved. Throws InputError for what is no checkpoint, or damaged.
  static Checkpoint from(const std::filesystem::path& file);
  Checkpoint(Checkpoint&& other) noexcept;
  Checkpoint(const Checkpoint&) = delete;
  Checkpoint& operator=(const Checkpoint&) = delete;
  Checkpoint& operator=(Checkpoint&&) = delete;
  ~Checkpoint();

  const std::filesystem::path& file() const { return m_file; }
  /// Whether items are read from the file; else they are written to it.
  bool restores() const { return m_restores; }

  void item(const std::string& name, double& value) { fixed(name, {&value, 1}); }
  void item(const std::string& name, long& value) { fixed(name, {&value, 1}); }
  void item(const std::string& name, Index& value) { fixed(name, {&value, 1}); }
  void item(const std::string& name, std::uint64_t& value) { fixed(name, {&value, 1}); }
  void item(const std::string& name, bool& value);
  void item(const std::string& name, Vec3& value) { fixed(name, {value.data(), 3}); }
  void item(const std::string& name, std::string& value);
  /// A list: gets the size that it was saved with.
  template <class T, class A> void item(const std::string& name, std::vector<T, A>& values) {
    if (restores()) values.resize(size(name));
    fixed(name, std::span<T>(values));
  }
  /// A column whose size both sides know: must have been saved with the same.
  void fixed(const std::string& name, std::span<double> values);
  void fixed(const std::string& name, std::span<long> values);
  void fixed(const std::string& name, std::span<Index> values);
  void fixed(const std::string& name, std::span<std::uint64_t> values);
  void fixed(const std::string& name, std::span<char> values);

  /// While restoring: whether anything was saved under a name, and how many values.
  bool has(const std::string& name) const;
  std::size_t size(const std::string& name) const;

  /// While restoring: throws InputError that says what was `found` under a name, unless `good`.
  void require(bool good, const std::string& name, const std::string& found) const;

  /// Ends saving: writes the file by way of a temporary beside it, so that one that was there
  /// is replaced by a whole one or not at all, whenever the machine stops; it is on the disk
  /// when this returns. Nothing while restoring. Throws OutputError when the disk is full or
  /// the folder read-only.
  void finish();

 private:
  Checkpoint(std::filesystem::path file, bool restores);
  /// Values in memory, of an HDF5 type.
  struct Block {
    std::int64_t type;
    std::size_t size;
    void* values;
  };
  void transfer(const std::string& name, const Block& block);
  void read(const std::string& name, const Block& block) const;
  void write(const std::string& name, const Block& block);

  std::filesystem::path m_file;
  bool m_restores;
  std::int64_t m_handle = -1;  ///< HDF5's, -1: closed
  std::size_t m_bytes = 0;     ///< of the file that is read
};

/// How a run keeps its state.
struct Keeping {
  std::filesystem::path file;  ///< the checkpoint; empty: none is written
  double interval = 30;  ///< least wall time between two, and before the first [s]; 0: one at
                         ///< every row of the history
  bool resume = false;   ///< go on from the file
  /// What the caller adds to every checkpoint, for the one who asks to go on
  /// (checkpoint_request).
  std::string request;
};

/// Keeping::request of a checkpoint. Throws InputError.
std::string checkpoint_request(const std::filesystem::path& file);

/// A method some of whose runs can go on after a stop, with bitwise the result of a run that
/// was not stopped, for any numbers of threads. Methods that can derive from this beside Method
/// (found by dynamic_cast).
class Resumable {
 public:
  virtual ~Resumable() = default;
  /// Method::run, with a checkpoint now and then, and one when it is interrupted or cannot
  /// write its results. To resume, request.out has to be the folder of the run that was
  /// stopped: its history and frames go on. Throws InputError, saying what differs, where the
  /// checkpoint is not of this problem, method, settings, arrangement.
  virtual void run_kept(const Problem& problem, const RunRequest& request,
                        const Keeping& keeping, Result& result) const = 0;
};

}  // namespace concord::scene
