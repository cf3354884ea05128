#pragma once
// What a study draws from its runs beside their own numbers: signals, errors, matched errors,
// heat maps, tables of cases. Their keys are described in studies/README.md.

#include "scene/errors.hpp"
#include "studies/driver/selector.hpp"

#include <string>
#include <vector>

namespace concord::studies {

/// How the runs selected make one number; range: max - min.
enum class Pool { max, min, mean, range };

/// Numbers of a column of history.csv, see signals.hpp.
struct Signal {
  std::string name, column;
  std::vector<std::string> features;
  double level = 0;            ///< of the period, in the column's unit
  double prominence = 0.05;    ///< of a peak, fraction of the record's range; ours: no source
  std::optional<double> from;  ///< [s]: samples before it do not count; absent: all count
  std::optional<double> to;    ///< [s]: nor those after it
  Selector selector;
  SourcePosition where;
};

/// errors.NAME of a run: a number against that of a reference run or an exact one, or a column
/// of the history against a reference run's.
struct ErrorEntry {
  std::string name;
  bool of_history = false;
  std::string quantity, column;                ///< one of them, by `of_history`
  std::optional<double> exact;                 ///< in SI
  Selector reference;                          ///< one case, where there is no `exact`
  std::optional<double> reference_resolution;  ///< absent: its finest
  bool is_signed = false;
  Selector selector;
  SourcePosition where;
};

/// Which time stands against the error.
enum class WorkTime { wall, total };

/// Time, memory and resolution of every case at chosen errors.
struct Matched {
  std::string title, quantity, note;
  WorkTime time = WorkTime::wall;
  std::vector<double> levels;  ///< relative errors, descending
  Selector selector;
  SourcePosition where;
};

struct HeatColumn {
  std::string label;
  Selector selector;
};

struct HeatRow {
  std::string label, quantity, unit = "1", note, absent;
  Selector selector;
  std::optional<double> resolution;
  Pool over_seeds = Pool::max;
  double good = 0, bad = 1;  ///< in `unit`: score 1 and 0
  bool logarithmic = false;
  int digits = 2;
};

struct TableColumn {
  std::string label, quantity, unit = "1";
  Pool over_seeds = Pool::mean;
  int digits = 3;
  bool difference = false;  ///< to the line's `against`
};

struct TableLine {
  std::string label, source_value;
  Selector selector;
  std::optional<double> resolution;
  std::optional<Selector> against;  ///< one case
};

/// A line a case (or a resolution of one), a column a pooled quantity.
struct RunTable {
  std::string title, note;
  std::vector<TableColumn> columns;
  std::vector<TableLine> lines;
  SourcePosition where;
};

struct Heatmap {
  std::string title;
  std::vector<HeatColumn> columns;
  std::vector<HeatRow> rows;
  SourcePosition where;
};

}  // namespace concord::studies
