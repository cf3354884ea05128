// Probe energy_drift: a long run of a conservative body: does its energy stay, does it stay
// smooth.

#include "studies/probes/states.hpp"
#include "studies/probes/whole_run.hpp"

#include <cmath>

namespace concord::probes {
namespace {

ProbeInfo drift_info() {
  return {"energy_drift",
          "Energy and momenta of a conservative body over many time steps",
          "central differences keep a nearby energy: E. Hairer, C. Lubich and G. Wanner, Acta "
          "Numerica 12 (2003) 399-450",
          {number_option("steps", "1", "1e6", 100, 1e9, ">= 100",
                         "time steps at the method's own step (about: dt_factor 0.8 of the "
                         "estimate at rest)")},
          {{"finished", "1",
            "share of the time that the run lived; below 1 drifts and trend are absent"},
           {"drift", "1",
            "largest change of kinetic + stored energy less external work, over the largest "
            "energy"},
           {"trend", "1",
            "mean energy of the last tenth less that of the first, over the mean of the first"},
           {"linear_momentum_drift", "1", "over sum m|v|"},
           {"angular_momentum_drift", "1", "over sum m|x||v|"},
           {"steps_done", "1", "time steps that were made"}}};
}

class EnergyDrift final : public Probe {
 public:
  const ProbeInfo& info() const override { return m_info; }

  void run(const ProbeRequest& request, scene::Result& result) const override {
    if (request.problem.is_static) {
      throw InputError({request.problem.file.string()}, "SCENE", "a static scene",
                       "a dynamic one");
    }
    scene::Problem problem = request.problem;
    {
      const std::unique_ptr<scene::DiscreteBody> body = request.body();
      const std::vector<double> rest(body->positions().size() * body->dim(), 0.0);
      problem.end_time =
          request.options.number("steps") * usual_factor * body->critical_step(rest);
    }
    problem.frames = 0;
    problem.history_rows = rows;
    const std::filesystem::path folder =
        request.run.out.empty() ? std::filesystem::path() : request.run.out / "run";
    const Attempt end = attempt(request, problem, folder);
    tell_run(end, result);
    auto& q = result.quantities;
    q["finished"] = end.failed ? end.result.t_end / problem.end_time : 1.0;
    q["steps_done"] = static_cast<double>(end.result.steps);
    if (end.failed) {  // drifts of a run cut short say nothing about all its steps
      result.notes["not_measured"] = "the run ended before its last step: " + end.error;
      return;
    }
    tell_momenta(end, q);
    if (!folder.empty()) tell_energy(folder, q);
  }

 private:
  static constexpr double usual_factor = 0.8;  ///< default of dt_factor of all methods
  static constexpr int rows = 1000;
  ProbeInfo m_info = drift_info();
};

const RegisterProbe<EnergyDrift> registered;

}  // namespace
}  // namespace concord::probes
