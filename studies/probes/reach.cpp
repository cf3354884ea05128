// Probe reach: how far a method goes along a static load path, and how it ends.

#include "studies/probes/whole_run.hpp"

namespace concord::probes {
namespace {

ProbeInfo reach_info() {
  return {
      "reach",
      "How far along a static load path equilibria are found, and how it ends",
      "issue of the study: compression, shear, torsion up to failure",
      {number_option("full", "1", "1", 1e-300, 1e300, "> 0",
                     "what the load parameter t = 1 stands for (0.8 of compression, 3 of "
                     "shear): told as `load`")},
      {{"reached", "1", "load parameter t of the last equilibrium; 1: all the way"},
       {"load", "1", "reached times the option `full`"},
       {"clean", "1",
        "1: the end is an equilibrium or a clear error, and every number on disk is finite; "
        "0: not so"}}};
}

class Reach final : public Probe {
 public:
  const ProbeInfo& info() const override { return m_info; }

  void run(const ProbeRequest& request, scene::Result& result) const override {
    if (!request.problem.is_static) {
      throw InputError({request.problem.file.string()}, "SCENE", "a dynamic scene",
                       "a static one, whose load grows with t from 0 to 1");
    }
    const std::filesystem::path folder =
        request.run.out.empty() ? std::filesystem::path() : request.run.out / "run";
    const Attempt end = attempt(request, request.problem, folder, true);
    tell_run(end, result);
    const double reached = end.failed ? end.result.t_end : 1.0;
    result.quantities["reached"] = reached;
    result.quantities["load"] = reached * request.options.number("full");
    const bool explained = !end.failed || !end.quantity.empty();
    if (!folder.empty()) result.quantities["clean"] = explained && all_finite(folder) ? 1 : 0;
  }

 private:
  ProbeInfo m_info = reach_info();
};

const RegisterProbe<Reach> registered;

}  // namespace
}  // namespace concord::probes
