#pragma once
// Fields of runs against those of a reference run, from the frames that both left.

#include "studies/driver/rows.hpp"

namespace concord::studies {

/// The [[compare]] entries that concern a run: of each name the first that selects its case. A
/// run that is the reference of a name is not compared under it.
std::vector<const Comparison*> comparisons_of(const Study& study, std::size_t case_index,
                                              double resolution, std::uint64_t seed);

/// Whether the last frame of a run is needed: it is compared, or the reference of a comparison.
bool needs_last_frame(const Study& study, std::size_t case_index, double resolution,
                      std::uint64_t seed);

/// Compares every row that a [[compare]] selects. At the run's own points X (particles, nodes)
/// the reference's nodal fields are interpolated by its own shape functions; a reference of
/// particles is compared particle by particle and must have the same ones. The difference is
/// Eq. (29) of the Continuum Bond Method paper over the points that `leave_out` leaves. Adds
/// errors.FIELD_NAME and `comparisons.NAME` (`reference`, `points`, `left_out`, or `reason`
/// where nothing could be compared) to the summaries, and writes RUN/NAME.hdf: a frame with
/// FIELD, FIELD_reference and FIELD_difference (run - reference). NAME: "difference" unless the
/// entry gives another. `out`: the study's folder.
void compare_runs(const Study& study, std::vector<Row>& rows, const std::filesystem::path& out);

}  // namespace concord::studies
