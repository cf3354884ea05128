#pragma once
// What CalculiX prints: tables (.dat), fields at nodes (.frd), converged increments (.sta).

#include <filesystem>
#include <functional>
#include <istream>
#include <string>
#include <vector>

namespace concord::calculix {

/// One table of a .dat file: "displacements (vx,vy,vz) for set NALL and time 0.5E+00" and rows.
struct DatTable {
  std::string quantity;  ///< "displacements", "total force", "equivalent plastic strain", ...
  std::string set;
  double time = 0;
  std::size_t columns = 0;
  std::vector<double> values;  ///< row after row, node or element numbers included
  std::size_t rows() const { return columns == 0 ? 0 : values.size() / columns; }
};

/// One block of a .frd file: a field at nodes.
struct FrdBlock {
  std::string name;  ///< "DISP", "STRESS", "PE", ...
  double time = 0;
  std::size_t components = 0;
  std::vector<int> nodes;
  std::vector<double> values;  ///< components a node
};

/// Hands every table to `take`, in the file's order, whether it is whole or the file ends
/// within it: callers know how many rows there must be. Throws SolveError with the line number
/// for a row that is no row of numbers.
void read_dat(std::istream& file, const std::function<void(const DatTable&)>& take);

/// Hands every whole block to `take`; one that the end of the file cuts off is left out. Throws
/// SolveError with the line number for lines that are none of the format's (CalculiX
/// GraphiX manual, "result format").
void read_frd(std::istream& file, const std::function<void(const FrdBlock&)>& take);

/// Converged increments of a .sta file.
struct Progress {
  double time = 0;      ///< total time of the last one
  long iterations = 0;  ///< of all
  long increments = 0;
};
Progress read_sta(std::istream& file);

}  // namespace concord::calculix
