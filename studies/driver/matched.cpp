// What a given error costs.

#include "studies/driver/work_precision.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace concord::studies {
namespace {

/// Between a and b at s in [0, 1], on a logarithmic scale where both are above 0; nothing where
/// one is unknown.
std::optional<double> between(double a, double b, double s) {
  if (!std::isfinite(a) || !std::isfinite(b)) return std::nullopt;
  if (a == b || !(a > 0) || !(b > 0)) return (1 - s) * a + s * b;
  return std::exp((1 - s) * std::log(a) + s * std::log(b));
}

void set(MatchedPoint& result, const WorkPoint& a, const WorkPoint& b, double s) {
  result.time = between(a.time, b.time, s);
  result.setup_s = between(a.setup_s, b.setup_s, s);
  result.wall_s = between(a.wall_s, b.wall_s, s);
  result.memory_mb = between(a.memory_mb, b.memory_mb, s);
  result.resolution = between(a.resolution, b.resolution, s);
  result.closes = a.closes && b.closes;
}

bool has_time(const MatchedPoint& point) {
  return point.status == MatchStatus::met || point.status == MatchStatus::met_by_coarsest;
}

/// Marks the least time of each scene at each level.
void mark_fastest(const Study& study, std::vector<MatchedCase>& cases) {
  for (MatchedCase& one : cases)
    for (std::size_t l = 0; l < one.at.size(); ++l) {
      const auto faster = [&](const MatchedCase& other) {
        return study.cases[other.case_index].scene == study.cases[one.case_index].scene &&
               has_time(other.at[l]) && *other.at[l].time < *one.at[l].time;
      };
      one.at[l].fastest =
          has_time(one.at[l]) && std::none_of(cases.begin(), cases.end(), faster);
    }
}

std::string name_of(const Case& entry) {
  return entry.method + (entry.variant.empty() ? "" : " (" + entry.variant + ")");
}

std::string percent(double level) { return fmt::format("{:.3g} %", 100 * level); }

/// The best case of a method: the least time, or where none has one the least error.
const MatchedCase* best_of(const Study& study, const std::vector<const MatchedCase*>& cases,
                           const std::string& method, std::size_t l) {
  const MatchedCase* best = nullptr;
  const auto better = [l](const MatchedPoint& a, const MatchedPoint& b) {
    if (has_time(a) != has_time(b)) return has_time(a);
    if (has_time(a)) return *a.time < *b.time;
    return a.finest_error.value_or(INFINITY) < b.finest_error.value_or(INFINITY);
  };
  for (const MatchedCase* one : cases)
    if (study.cases[one->case_index].method == method &&
        (!best || better(one->at[l], best->at[l])))
      best = one;
  return best;
}

/// "3.2 times", "41 times".
std::string times(double ratio) {
  return fmt::format("{:.{}f} times", ratio, ratio < 10 ? 1 : 0);
}

std::string remark(const MatchedPoint& point) {
  return point.closes ? "" : " (energy balance does not close)";
}

/// "delaunay (xi 1) takes 3.2 times as long" of a method that is not the fastest.
std::string against(const Case& entry, const MatchedPoint& point, const MatchedPoint& least) {
  const std::string name = name_of(entry);
  const bool bound = point.status == MatchStatus::met_by_coarsest;
  const bool least_bound = least.status == MatchStatus::met_by_coarsest;
  if (has_time(point))
    return fmt::format("{} takes {}{} as long{}{}", name,
                       bound == least_bound ? "" : (bound ? "at most " : "at least "),
                       times(*point.time / *least.time),
                       bound && least_bound ? " with its coarsest" : "", remark(point));
  if (point.status == MatchStatus::no_value) return name + " gives no value";
  return fmt::format("{} does not reach it ({} at its finest, after {} as long){}", name,
                     percent(*point.finest_error), times(*point.finest_time / *least.time),
                     remark(point));
}

/// One sentence: a scene at a level.
std::string sentence(const Study& study, const Matched& entry, std::size_t l,
                     const std::vector<const MatchedCase*>& cases) {
  const std::string where =
      study.cases[cases.front()->case_index].scene + ", " + percent(entry.levels[l]) + ": ";
  const auto first = std::find_if(cases.begin(), cases.end(),
                                  [l](const MatchedCase* one) { return one->at[l].fastest; });
  if (first == cases.end()) return where + "no case reaches it.";
  const Case& fastest = study.cases[(*first)->case_index];
  const MatchedPoint& least = (*first)->at[l];
  std::string text = fmt::format(
      "{}{} is the fastest with {}{:.3g} s{}", where, name_of(fastest),
      least.status == MatchStatus::met ? "" : "at most ", *least.time, remark(least));
  std::vector<std::string> methods{fastest.method};
  for (const MatchedCase* one : cases) {
    const std::string& method = study.cases[one->case_index].method;
    if (std::find(methods.begin(), methods.end(), method) != methods.end()) continue;
    text += methods.size() == 1 ? "; " : ", ";
    methods.push_back(method);
    const MatchedCase* best = best_of(study, cases, method, l);
    text += against(study.cases[best->case_index], best->at[l], least);
  }
  return text + ".";
}

/// The selected case of a claim, matched; nothing where this mode runs none.
std::optional<MatchedPoint> matched_case(const Study& study, const std::vector<Row>& rows,
                                         const Claim& claim, const Selector& selector,
                                         const std::string& quantity) {
  const auto curves = work_curves(study, rows, selector, quantity, claim.time);
  if (curves.empty()) return std::nullopt;
  return match(curves.front(), claim.level);
}

std::string why_unusable(const char* what, const MatchedPoint& point) {
  return fmt::format("{}: {}{}{}", what, to_text(point.status),
                     point.reason.empty() ? "" : ", " + point.reason,
                     point.finest_error ? ", finest error " + percent(*point.finest_error)
                                        : "");
}

/// Why the ratio of times is only a lower bound; empty where it is not.
std::vector<std::string> bounds_of(const MatchedPoint& one, const MatchedPoint& other) {
  std::vector<std::string> remarks;
  if (other.status == MatchStatus::not_reached)
    remarks.push_back(fmt::format(
        "a lower bound: the other case does not reach {}, its finest run has {} after {:.3g} s",
        percent(one.level), percent(*other.finest_error), *other.finest_time));
  if (one.status == MatchStatus::met_by_coarsest)
    remarks.push_back("a lower bound: the coarsest run of the case selected is below " +
                      percent(one.level));
  return remarks;
}

}  // namespace

const char* to_text(MatchStatus status) {
  switch (status) {
    case MatchStatus::met:
      return "met";
    case MatchStatus::met_by_coarsest:
      return "met by the coarsest";
    case MatchStatus::not_reached:
      return "not reached";
    case MatchStatus::no_value:
      return "no value";
  }
  return "";
}

MatchedPoint match(const WorkCurve& curve, double level) {
  MatchedPoint result;
  result.level = level;
  const auto& points = curve.points;
  if (points.empty()) {
    result.reason = curve.absent.empty() ? "no run" : curve.absent.back().second;
    return result;
  }
  result.finest_error = points.back().error;
  result.finest_time = points.back().time;
  std::size_t below = points.size();  // all from here on are at or below the level
  while (below > 0 && points[below - 1].error <= level) --below;
  if (below == points.size()) {
    result.status = MatchStatus::not_reached;
    result.dips = std::any_of(points.begin(), points.end(),
                              [level](const WorkPoint& point) { return point.error <= level; });
    result.closes = points.back().closes;
  } else if (below == 0) {
    result.status = MatchStatus::met_by_coarsest;
    set(result, points.front(), points.front(), 0);
  } else {
    const WorkPoint &a = points[below - 1], &b = points[below];
    result.status = MatchStatus::met;
    set(result, a, b, std::log(a.error / level) / std::log(a.error / b.error));
  }
  return result;
}

std::vector<MatchedCase> matched_cases(const Study& study, const std::vector<Row>& rows,
                                       const Matched& entry) {
  std::vector<MatchedCase> cases;
  for (const WorkCurve& curve :
       work_curves(study, rows, entry.selector, entry.quantity, entry.time)) {
    MatchedCase one{curve.case_index, {}};
    for (const double level : entry.levels) one.at.push_back(match(curve, level));
    cases.push_back(std::move(one));
  }
  mark_fastest(study, cases);
  return cases;
}

std::vector<std::string> sentences_of(const Study& study, const Matched& entry,
                                      const std::vector<MatchedCase>& cases) {
  std::vector<std::string> scenes, sentences;
  for (const MatchedCase& one : cases) {
    const std::string& scene = study.cases[one.case_index].scene;
    if (std::find(scenes.begin(), scenes.end(), scene) == scenes.end()) scenes.push_back(scene);
  }
  for (const std::string& scene : scenes) {
    std::vector<const MatchedCase*> there;
    for (const MatchedCase& one : cases)
      if (study.cases[one.case_index].scene == scene) there.push_back(&one);
    for (std::size_t l = 0; l < entry.levels.size(); ++l)
      sentences.push_back(sentence(study, entry, l, there));
  }
  return sentences;
}

MatchedRatio matched_ratio(const Study& study, const Claim& claim,
                           const std::vector<Row>& rows) {
  const auto one = matched_case(study, rows, claim, claim.selector, claim.quantity);
  const auto other = matched_case(study, rows, claim, claim.other, claim.other_quantity);
  if (!one || !other) return {{}, "a case of this claim does not run in this mode", {}};
  if (!has_time(*one)) return {{}, why_unusable("the case selected", *one), {}};
  const bool other_slower = other->status == MatchStatus::not_reached;
  if (other->status != MatchStatus::met && !other_slower)
    return {{}, why_unusable("the other case", *other), {}};
  // A coarser run was below the level: how long the case needs is not bounded by its finest.
  if (other_slower && other->dips)
    return {{}, why_unusable("the other case", *other) + ", its errors are not monotone", {}};
  MatchedRatio ratio{(other_slower ? *other->finest_time : *other->time) / *one->time, "", {}};
  ratio.remarks = bounds_of(*one, *other);
  if (!ratio.remarks.empty() && claim.maximum) {
    ratio.reason = fmt::format("only a lower bound, {:.3g}: it cannot meet max", *ratio.value);
    ratio.value.reset();
  }
  if (!one->closes || !other->closes)
    ratio.remarks.push_back("energy balance does not close: a run of the " +
                            std::string(one->closes ? "other case" : "case selected"));
  return ratio;
}

}  // namespace concord::studies
