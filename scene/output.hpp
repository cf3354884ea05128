#pragma once
// Files of a run: history.csv, VTKHDF frames, summary.json.

#include "scene/method.hpp"

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace concord::scene {

/// history.csv: one header line with SI units in the names; every row is on disk when append
/// returns.
class HistoryWriter {
 public:
  HistoryWriter() = default;  ///< writes nothing
  HistoryWriter(const std::filesystem::path& file, const std::vector<std::string>& columns);
  void append(std::span<const double> row);
  bool active() const { return m_stream.is_open(); }

 private:
  std::ofstream m_stream;
  std::size_t m_columns = 0;
};

/// A named field over points or cells: `components` is 1, 3 or 9, values point after point.
struct FrameField {
  std::string name;
  int components = 1;
  std::span<const double> values;
};

/// One VTKHDF frame in a file of its own, written by way of a temporary. Arguments as
/// FrameWriter::write.
void write_frame(const std::filesystem::path& file, double time, std::span<const Vec3> points,
                 const std::vector<FrameField>& point_fields,
                 std::span<const Index> connectivity = {}, std::span<const Index> offsets = {},
                 std::span<const unsigned char> types = {});

/// VTKHDF 1.0 UnstructuredGrid frames, `fields_0000.hdf`, ..., and `fields.hdf.series` with
/// their times. Positions are current ones; "displacement" must be among the point fields for
/// reference positions.
class FrameWriter {
 public:
  FrameWriter() = default;  ///< writes nothing
  explicit FrameWriter(const std::filesystem::path& folder);
  /// Cells: connectivity in VTK order, offsets (size cells+1) and VTK cell types. No cells
  /// given: every point is a vertex cell.
  void write(double time, std::span<const Vec3> points,
             const std::vector<FrameField>& point_fields,
             std::span<const Index> connectivity = {}, std::span<const Index> offsets = {},
             std::span<const unsigned char> types = {});
  bool active() const { return !m_folder.empty(); }

 private:
  std::filesystem::path m_folder;
  std::vector<std::pair<std::string, double>> m_series;
};

/// Identity of a run for summary.json beside the Result.
struct RunIdentity {
  std::string scene, method, variant;
  int dim = 3;
  double resolution = 0;
  double perturb = 0;
  std::uint64_t seed = 0;
};

/// summary.json as in the contract, as text. `error` non-empty marks a run that stopped early,
/// with the reason.
std::string summary_json(const RunIdentity& id, const Result& result,
                         const std::string& error = "");

/// Peak resident memory of this process so far [MB].
double peak_rss_mb();
/// "AVX-512", "AVX2" or "SSE2": the widest set that the kernels pick on this processor; and the
/// processor's name.
std::string simd_name();
std::string cpu_name();

/// Writes text to a file by way of a temporary beside it, so that a reader never sees half a
/// file.
void write_file(const std::filesystem::path& file, const std::string& text);

}  // namespace concord::scene
