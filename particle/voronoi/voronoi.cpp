#include "particle/voronoi/voronoi.hpp"

#include "particle/voronoi/operators.hpp"
#include "particle/voronoi/sweep.hpp"

#include <variant>

namespace concord::particle::voronoi {
namespace {

/// The kernels of one body in Dim dimensions.
template <int Dim> class Evaluation {
 public:
  Evaluation(const Stars& stars, const GhostSystems& ghosts, const Cells& cells,
             const ContactFactors& factors, Form form, std::optional<Viscosity> viscosity)
      : m_setting{stars.body(),
                  make_bonds(stars.body(), cells),
                  make_ghosts<Dim>(stars, ghosts, factors.normal, factors.tangential),
                  {},
                  {},
                  factors,
                  form,
                  viscosity} {
    m_setting.reach = Reach(m_setting.bonds.begin, m_setting.bonds.other);
    for (const double V : cells.V) m_setting.inverse_V.push_back(1 / V);
  }

  const Setting<Dim>& setting() const { return m_setting; }

  void forces(const Constitution& constitution, const double* u, const double* v, double* f,
              const Executor& executor) {
    FirstBad bad;
    for_all(executor, [&](Space<Dim>& space, ParticleRange part) {
      bad.tell(Sweep<Dim>(m_setting, constitution, space, u, v).forces(part, f));
    });
    bad.check();
  }

  void gradients(const Constitution& constitution, const double* u, std::span<Mat3> H) {
    visit(constitution, u, Executor(1),
          [&](Index first, Index last, Window<Dim>, Window<Dim> window, GhostVectors<Dim>) {
            for (Index a = first; a < last; ++a)
              H[a] = constitution.complete(tensor_of<Dim>(window.at(a)));
          });
    for (auto p = static_cast<std::size_t>(particles()); p < H.size(); ++p)
      H[p] = H[m_setting.body.particle_at(static_cast<Index>(p))];
  }

  Energies energies(const Constitution& constitution, const double* u,
                    const Executor& executor) {
    ChunkedEnergies energies(particles());
    visit(constitution, u, executor,
          [&](Index first, Index last, Window<Dim> mean, Window<Dim> H,
              GhostVectors<Dim> vectors) {
            for (Index a = first; a < last; ++a) {
              energies.add(a, m_setting.body.V[a],
                           constitution.energy(a, tensor_of<Dim>(H.at(a))),
                           m_setting.contact() ? contact_energies(a, mean, vectors) : 0.0);
            }
          });
    return energies.total();
  }

 private:
  Index particles() const { return m_setting.bonds.particles(); }

  /// Of four loops that cost about the same, forces, duals, faces and gradients, a sweep does 1
  /// to 4 rings below its part and 0 to 3 above it.
  Overlap overlap() const {
    const double ring = m_setting.reach.mean();
    return {2.5 * ring, 1.5 * ring};
  }

  /// work(space, part) for ranges that make up all particles.
  template <class Work> void for_all(const Executor& executor, const Work& work) {
    m_spaces.provide(executor.threads(),
                     [&] { return std::make_unique<Space<Dim>>(m_setting); });
    const ParticleRange all{0, particles()};
    m_spaces.for_parts({&all, 1}, executor, overlap(), work);
  }

  template <class Use>
  void visit(const Constitution& constitution, const double* u, const Executor& executor,
             const Use& use) {
    for_all(executor, [&](Space<Dim>& space, ParticleRange part) {
      Sweep<Dim>(m_setting, constitution, space, u, u).gradients(part, use);
    });
  }

  /// Contact energies (49) of the bonds in row a and of its ghosts.
  double contact_energies(Index a, Window<Dim> mean, GhostVectors<Dim> vectors) const {
    const Bonds& bonds = m_setting.bonds;
    const double* X = m_setting.body.X.data();
    const Tensor<Dim> mean_a = Tensor<Dim>::load(mean.at(a));
    const Vec<Dim> u_a = load<Vec<Dim>>(mean.at(a) + vector_place<Dim>),
                   X_a = point_of<Dim>(X, a);
    double energy = 0;
    for (Index k = bonds.begin[a]; k < bonds.begin[a + 1]; ++k) {
      const double* mean_b = mean.at(bonds.other[k]);
      const Vec<Dim> u_ab = load<Vec<Dim>>(mean_b + vector_place<Dim>) - u_a,
                     X_ab = point_of<Dim>(X, bonds.other[k]) - X_a;
      Tensor<Dim> sum = Tensor<Dim>::load(mean_b);
      for (int i = 0; i < Dim; ++i) sum.column[i] += mean_a.column[i];
      energy += contact_energy<Dim>(
          m_setting.factors, 2 * bonds.shape[k * shape_size + ratio_at], X_ab, u_ab, sum);
    }
    for (Index g = m_setting.ghosts.begin[a]; g < m_setting.ghosts.begin[a + 1]; ++g) {
      const GhostRecord<Dim>& ghost = m_setting.ghosts.record[g];
      if (!ghost.prescribed()) continue;
      const Vec<Dim> local = load<Vec<Dim>>(vectors.u(g)) - mean_a.times(ghost.X);
      energy += 0.5 * lane_sum(local * ghost.K.times(local));
    }
    return energy;
  }

  Setting<Dim> m_setting;
  Spaces<Space<Dim>> m_spaces;
};

}  // namespace

class VoronoiModel::Implementation {
 public:
  Implementation(const Body& body, const scene::Problem& problem, const Cells& cells,
                 const Boundary& boundary, const Parameters& parameters,
                 const Executor& executor)
      : m_bonds(cells.interior), m_stars(body, cells, boundary),
        m_ghosts(solve_all_ghosts(m_stars, problem.geometry_where, executor)),
        m_factors{parameters.xi_n * problem.material.E, parameters.xi_t * problem.material.mu},
        m_form(parameters.form),
        m_viscosity(
            artificial_viscosity(parameters.c1, parameters.c2, problem.material, body.h_min)) {
    if (body.dim == 3)
      m_evaluation = std::make_unique<Evaluation<3>>(m_stars, m_ghosts, cells, m_factors,
                                                     m_form, m_viscosity);
    else
      m_evaluation = std::make_unique<Evaluation<2>>(m_stars, m_ghosts, cells, m_factors,
                                                     m_form, m_viscosity);
    m_load_terms = voronoi::load_terms(m_stars, m_ghosts, boundary, m_form);
  }

  Form form() const { return m_form; }
  const std::optional<Viscosity>& viscosity() const { return m_viscosity; }
  const std::vector<LoadTerm>& load_terms() const { return m_load_terms; }
  std::size_t bonds() const { return m_bonds; }

  template <class F> auto evaluate(const F& f) {
    return std::visit([&](auto& evaluation) { return f(*evaluation); }, m_evaluation);
  }

  const Stiffness& tangent(const Constitution& constitution, std::span<const double> u) {
    if (!m_operators) {
      m_operators.emplace(m_stars, m_ghosts, m_form, m_factors);
      m_tangent = m_operators->pattern();
    }
    m_operators->tangent(constitution, u, m_tangent);
    return m_tangent;
  }

 private:
  std::size_t m_bonds;
  Stars m_stars;
  GhostSystems m_ghosts;
  ContactFactors m_factors;
  Form m_form;
  std::optional<Viscosity> m_viscosity;
  std::variant<std::unique_ptr<Evaluation<2>>, std::unique_ptr<Evaluation<3>>> m_evaluation;
  std::vector<LoadTerm> m_load_terms;
  std::optional<Operators> m_operators;  ///< made when the first tangent is asked for
  Stiffness m_tangent;
};

VoronoiModel::VoronoiModel(const Body& body, const scene::Problem& problem, const Cells& cells,
                           const Boundary& boundary, const Parameters& parameters,
                           const Executor& executor)
    : ForceModel(body, problem), m_implementation(std::make_unique<Implementation>(
                                     body, problem, cells, boundary, parameters, executor)) {}

VoronoiModel::~VoronoiModel() = default;

const std::vector<LoadTerm>& VoronoiModel::load_terms() const {
  return m_implementation->load_terms();
}

void VoronoiModel::forces(std::span<const double> u, std::span<const double> v,
                          std::span<double> f, const Executor& executor) {
  m_implementation->evaluate([&](auto& evaluation) {
    evaluation.forces(m_constitution, u.data(), v.data(), f.data(), executor);
  });
}

Energies VoronoiModel::energies(std::span<const double> u, const Executor& executor) {
  return m_implementation->evaluate([&](auto& evaluation) {
    return evaluation.energies(m_constitution, u.data(), executor);
  });
}

void VoronoiModel::gradients(std::span<const double> u, std::span<Mat3> H) {
  m_implementation->evaluate(
      [&](auto& evaluation) { evaluation.gradients(m_constitution, u.data(), H); });
}

const ForceModel::Stiffness& VoronoiModel::tangent(std::span<const double> u) {
  return m_implementation->tangent(m_constitution, u);
}

bool VoronoiModel::has_potential() const {
  if (m_implementation->form() == Form::face_compatible) return true;
  return m_implementation->form() == Form::conserving && m_body.n == m_body.bulk;
}

bool VoronoiModel::viscous() const { return m_implementation->viscosity().has_value(); }

double VoronoiModel::viscous_damping_ratio(double omega_max) const {
  if (!viscous()) return 0;
  const LameConstants& lame = m_constitution.kernel().constants.lame;
  return m_implementation->viscosity()->damping_ratio(lame, omega_max);
}

std::size_t VoronoiModel::interactions() const { return m_implementation->bonds(); }

}  // namespace concord::particle::voronoi
