// Checkpoints that do not fit the run, although their checksum is right: bad input, never
// worse. And what has to be on the disk before a checkpoint may say that it is there.

#include "scene/continued_output.hpp"
#include "scene/crc64.hpp"
#include "scene/hdf5_handle.hpp"
#include "tests/property/resumed_run.hpp"
#include "tests/unit/scene/disk_calls.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <optional>

namespace concord::particle::test {
namespace {

using scene::Hdf5Handle;

const Case plate{"pmma_plate",
                 1,
                 {{"parameters.width", "20 mm"},
                  {"parameters.crack", "10 mm"},
                  {"parameters.strip", "8 mm"},
                  {"end_time", "90 us"},
                  {"output.frames", "4"},
                  {"output.history_rows", "30"}}};

/// Edits the items of a checkpoint, and gives it the checksum that fits.
template <class Edit> void edit(const fs::path& file, const Edit& change) {
  constexpr std::size_t trailer = 16;  // "crc64/xz" and the checksum
  std::string bytes = contents(file);
  const std::string tag = bytes.substr(bytes.size() - trailer, trailer / 2);
  const fs::path plain = file.string() + ".plain";
  std::ofstream(plain, std::ios::binary) << bytes.substr(0, bytes.size() - trailer);
  {
    const Hdf5Handle handle(H5Fopen(plain.c_str(), H5F_ACC_RDWR, H5P_DEFAULT), H5Fclose,
                            "open");
    change(handle);
  }
  bytes = contents(plain);
  const std::uint64_t sum = scene::crc64_of(bytes);
  bytes += tag;
  bytes.append(reinterpret_cast<const char*>(&sum), sizeof sum);
  fs::remove(plain);
  fs::remove(file);  // to write over it would wait for the disk
  std::ofstream(file, std::ios::binary) << bytes;
}

std::vector<std::string> items(hid_t file) {
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5L_info_t*, void* list) {
    static_cast<std::vector<std::string>*>(list)->emplace_back(name);
    return herr_t{0};
  };
  H5Literate(file, H5_INDEX_NAME, H5_ITER_INC, nullptr, add, &names);
  return names;
}

/// One item of a checkpoint, to be written anew.
struct Item {
  std::string name;
  H5T_class_t kind;
  hid_t type;
  std::size_t bytes;  ///< of a value
  std::vector<char> values;

  std::size_t size() const { return values.size() / bytes; }
  /// Every value becomes this one.
  template <class T> void fill(T value) {
    for (std::size_t k = 0; k + sizeof value <= values.size(); k += sizeof value)
      std::memcpy(values.data() + k, &value, sizeof value);
  }
  template <class T> void fill_integers(bool largest) {
    fill<T>(largest ? std::numeric_limits<T>::max() : T(-1));
  }
};

Item read_item(hid_t file, const std::string& name) {
  const Hdf5Handle set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose, "open " + name);
  const Hdf5Handle space(H5Dget_space(set), H5Sclose, "space"),
      type(H5Dget_type(set), H5Tclose, "type");
  Item item{name, H5Tget_class(type), H5T_NATIVE_CHAR, H5Tget_size(type), {}};
  if (item.kind == H5T_FLOAT) item.type = H5T_NATIVE_DOUBLE;
  if (item.kind == H5T_INTEGER && item.bytes == 4) item.type = H5T_NATIVE_INT32;
  if (item.kind == H5T_INTEGER && item.bytes == 8)
    item.type = H5Tget_sign(type) == H5T_SGN_NONE ? H5T_NATIVE_UINT64 : H5T_NATIVE_INT64;
  item.values.resize(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)) *
                     item.bytes);
  H5Dread(set, item.type, H5S_ALL, H5S_ALL, H5P_DEFAULT, item.values.data());
  return item;
}

void write_item(hid_t file, const Item& item) {
  H5Ldelete(file, item.name.c_str(), H5P_DEFAULT);
  const hsize_t extent = item.size();
  const Hdf5Handle space(H5Screate_simple(1, &extent, nullptr), H5Sclose, "space");
  const Hdf5Handle set(H5Dcreate2(file, item.name.c_str(), item.type, space, H5P_DEFAULT,
                                  H5P_DEFAULT, H5P_DEFAULT),
                       H5Dclose, "make " + item.name);
  if (extent > 0) H5Dwrite(set, item.type, H5S_ALL, H5S_ALL, H5P_DEFAULT, item.values.data());
}

enum class Change { negative, largest, not_a_number, longer, shorter, gone };
constexpr Change changes[] = {Change::negative, Change::largest, Change::not_a_number,
                              Change::longer,   Change::shorter, Change::gone};

/// False where the item cannot be changed like that.
bool apply(Item& item, Change change) {
  if (change == Change::longer) item.values.resize(item.values.size() + item.bytes, 0);
  if (change == Change::shorter && item.size() < 1) return false;
  if (change == Change::shorter) item.values.resize(item.values.size() - item.bytes);
  if (change >= Change::longer) return true;
  if (item.values.empty() || item.bytes == 1) return false;
  if (item.kind == H5T_FLOAT) {
    const double value = change == Change::negative  ? -1
                         : change == Change::largest ? std::numeric_limits<double>::max()
                                                     : std::nan("");
    item.fill(value);
  } else if (change == Change::not_a_number) {
    return false;
  } else if (item.bytes == 4) {
    item.fill_integers<std::int32_t>(change == Change::largest);
  } else {
    item.fill_integers<std::int64_t>(change == Change::largest);
  }
  return true;
}

/// Ends a run that has gone on for a row, without the checkpoint of one that is interrupted.
struct Enough {};

class DamagedCheckpoint : public testing::TestWithParam<std::string> {};

bool begins(const std::string& text, const char* with) { return text.rfind(with, 0) == 0; }

/// Whether a run cannot go on with such an item: what is gone or of another size, indices, and
/// what the files of the run are known by.
bool is_no_choice(const std::string& name, Change change) {
  if (name == "request") return false;  // read by who asked for the run
  if (change == Change::gone || name == "record.broken_a" || name == "record.broken_b" ||
      name == "record.dead" || name == "recorder.history_bytes" ||
      name == "recorder.history_digest" || name == "recorder.frame_digests")
    return true;
  const bool any_size = name == "program" || begins(name, "outcome.resumed");
  return change >= Change::longer && !any_size;
}

enum class End { refused, went_on, failed };

/// Goes on for a row with a copy of a run in which one item is changed. Nothing where the item
/// cannot be changed like that.
std::optional<End> with_changed(const Variant& variant, const fs::path& whole,
                                const fs::path& part, const std::string& name, Change change) {
  fs::remove_all(part);
  fs::copy(whole, part, fs::copy_options::recursive);
  bool changed = false;
  edit(part / "checkpoint.hdf", [&](hid_t file) {
    Item item = read_item(file, name);
    changed = apply(item, change);
    if (changed) write_item(file, item);
    if (change == Change::gone) H5Ldelete(file, name.c_str(), H5P_DEFAULT);
  });
  if (!changed) return std::nullopt;
  scene::Result result;
  try {
    RunInFolder{plate, variant, part, [] { throw Enough(); }}(1, true, 1, result);
  } catch (const Enough&) {
  } catch (const SolveError&) {
    return End::failed;
  } catch (const InputError& error) {
    EXPECT_EQ(error.where().file.rfind(part.string(), 0), 0u) << error.what();
    for (const std::string& file : files_in(whole))
      EXPECT_EQ(contents(whole / file), contents(part / file)) << "untouched: " << file;
    return End::refused;
  }
  return End::went_on;
}

}  // namespace

/// Every item with other values, longer, shorter, gone. What indexes something, or counts, is
/// bad input; a number that only may be wrong runs on or ends in a SolveError.
TEST_P(DamagedCheckpoint, IsBadInputOrFailsInItsNumerics) {
  const Variant variant{GetParam(), GetParam(), {}};
  const Scratch scratch;
  const fs::path whole = scratch / "whole";
  ::setenv("CONCORD_CACHE", (scratch / "cache").c_str(), 1);  // one body for all
  scene::Result result;
  ASSERT_FALSE((RunInFolder{plate, variant, whole}(1, false, 24, result)));
  std::vector<std::string> names;
  edit(whole / "checkpoint.hdf", [&](hid_t file) {
    names = items(file);
    for (const char* list : {"record.broken_a", "record.dead", "recorder.frame_digests"})
      ASSERT_GT(read_item(file, list).size(), 0u) << list;
  });
  ASSERT_GT(names.size(), 50u);
  int refused = 0, other = 0;
  for (const std::string& name : names) {
    for (const Change change : changes) {
      if (begins(name, "fact.") && change != Change::gone) continue;
      if (begins(name, "account.") && change != Change::not_a_number) continue;  // sums
      SCOPED_TRACE(name + ", change " + std::to_string(static_cast<int>(change)));
      const std::optional<End> end =
          with_changed(variant, whole, scratch / "part", name, change);
      if (!end) continue;
      ++(*end == End::refused ? refused : other);
      if (is_no_choice(name, change)) EXPECT_EQ(*end, End::refused);
    }
  }
  ::unsetenv("CONCORD_CACHE");
  EXPECT_GT(refused, 100);
  EXPECT_GT(other, 20);
}

INSTANTIATE_TEST_SUITE_P(Methods, DamagedCheckpoint, testing::Values("cbm", "tlsph"));

/// Before a checkpoint takes its name, what it builds on is on the disk: history, frames that
/// are new, their names; then itself; then its name.
TEST(CheckpointOnTheDisk, ComesAfterTheFilesItBuildsOn) {
  const Variant variant{"delaunay", "delaunay", {}};
  const Case what{
      "swinging_cube",
      3,
      {{"end_time", "60 ms"}, {"output.frames", "2"}, {"output.history_rows", "4"}}};
  const Scratch scratch;
  RunInFolder run{what, variant, scratch / "r"};
  run.interval = 0;
  scene::Result result;
  const concord::test::DiskCalls calls;
  ASSERT_TRUE(run(1, false, -1, result));
  std::vector<std::string> between;
  int checkpoints = 0, frames = 0;
  for (const std::string& call : calls.log()) {
    if (call == "rename checkpoint.hdf") {
      ++checkpoints;
      EXPECT_EQ(between.back(), "fsync checkpoint.hdf.part");
      ASSERT_GE(between.size(), 3u);
      EXPECT_EQ(between[between.size() - 2], "fsync r") << "the names of the frames";
      EXPECT_EQ(std::count(between.begin(), between.end(), "fsync history.csv"), 1);
      for (; fs::exists(run.out / ("fields_000" + std::to_string(frames) + ".hdf")) &&
             std::count(between.begin(), between.end(),
                        "rename fields_000" + std::to_string(frames) + ".hdf") > 0;
           ++frames) {
        EXPECT_EQ(std::count(between.begin(), between.end(),
                             "fsync fields_000" + std::to_string(frames) + ".hdf"),
                  1);
      }
      between.clear();
      continue;
    }
    between.push_back(call);
  }
  EXPECT_EQ(between.front(), "fsync r") << "the name of the last checkpoint";
  EXPECT_GE(checkpoints, 4);
  EXPECT_EQ(frames, 3);
}

}  // namespace concord::particle::test
