#include "particle/delaunay/delaunay.hpp"

#include "particle/core/features.hpp"

namespace concord::particle::delaunay {

/// What one worker's sweep needs beside the model: windows over particles, buffers.
class DelaunayModel::Space {
 public:
  Space(const Bonds& bonds, const Reach& reach, int dim, bool contact, bool viscous)
      : buffer(bonds.begin, dim, contact), m_mask(reach.window(2) - 1) {
    const std::size_t size = reach.window(2) * (dim == 3 ? record_size<3> : record_size<2>);
    m_H.assign(size, 0.0);
    m_P = m_H;
    if (viscous) m_rate = m_H;
  }
  template <int Dim> Window<Dim> H() { return {m_H.data(), m_mask}; }
  template <int Dim> Window<Dim> P() { return {m_P.data(), m_mask}; }
  template <int Dim> Window<Dim> rate() { return {m_rate.data(), m_mask}; }

  ContactBuffer buffer;

 private:
  std::size_t m_mask;
  Column m_H, m_P, m_rate;
};

/// One pass over a range of particles: gradients run ahead of contact and stress, these ahead
/// of forces, by what the rows of bonds reach. Sweeps recompute what they share with others.
template <int Dim> class DelaunayModel::Sweep {
 public:
  Sweep(DelaunayModel& model, Space& space, const double* u, const double* v)
      : m_model(model), m_reach(model.m_reach), m_bonds(model.m_bonds), m_u(u), m_v(v),
        m_H(space.H<Dim>()), m_P(space.P<Dim>()), m_rate(space.rate<Dim>()),
        m_buffer(space.buffer) {}

  /// f of the particles of `part`. Returns the first particle met with det F <= 0 or NaN, or
  /// -1.
  Index forces(ParticleRange part, double* f) {
    m_part = part;
    Index done = m_reach.bottom(part.first);  // rows that add to the part's forces
    m_stresses = m_opened_P = contact() ? m_reach.bottom(done) : done;
    start_gradients(m_stresses);
    while (done < part.last) {
      const Index last = std::min(done + Reach::chunk, part.last);
      stresses_to(m_reach.top(last));
      force_rows<Dim>(m_bonds, done, last, m_P);
      if (last > part.first) copy_vectors<Dim>(m_P, std::max(done, part.first), last, f);
      done = last;
    }
    return m_bad;
  }

  /// use(first, last, H) for the particles of `part`, with H complete there and at the ends of
  /// their rows.
  template <class Use> void gradients(ParticleRange part, const Use& use) {
    start_gradients(part.first);
    for (Index first = part.first; first < part.last; first += Reach::chunk) {
      const Index last = std::min(first + Reach::chunk, part.last);
      gradients_to(m_reach.top(last));
      use(first, last, m_H);
    }
  }

 private:
  bool contact() const { return features::contact && m_model.m_contact; }
  bool viscous() const { return features::viscosity && m_model.m_viscosity; }

  /// H is wanted from particle `first` on.
  void start_gradients(Index first) { m_gradients = m_opened_H = m_reach.bottom(first); }

  void gradients_to(Index last) {
    while (m_gradients < last) {
      const Index end = std::min(m_gradients + Reach::chunk, m_bonds.particles());
      const Index top = m_reach.top(end);
      if (top > m_opened_H) {
        open_records<Dim>(m_H, m_opened_H, top, m_u);
        if (viscous()) open_records<Dim>(m_rate, m_opened_H, top, m_v);
        m_opened_H = top;
      }
      const double* inverse_V = m_model.m_inverse_V.data();
      gradient_rows<Dim>(m_bonds, m_gradients, end, inverse_V, m_H);
      if (viscous()) gradient_rows<Dim>(m_bonds, m_gradients, end, inverse_V, m_rate);
      m_gradients = end;
    }
  }

  void stresses_to(Index last) {
    while (m_stresses < last) {
      const Index end = std::min(m_stresses + Reach::chunk, m_bonds.particles());
      const Index top = m_reach.top(end);
      if (contact()) {
        gradients_to(top);
        if (top > m_opened_P) open_records<Dim>(m_P, m_opened_P, top);
        m_opened_P = std::max(m_opened_P, top);
        contact_rows<Dim>(m_bonds, m_stresses, end, m_model.m_factors, m_model.m_body.X.data(),
                          m_H, m_P, m_buffer);
      } else {
        gradients_to(end);
      }
      by_ownership(m_part, m_stresses, end,
                   [&](Index from, Index to, bool own) { stress(from, to, own); });
      if (viscous()) add_viscous_stress(m_stresses, end);
      m_stresses = end;
    }
  }

  /// Only the part's own particles keep a plastic trial state.
  void stress(Index first, Index last, bool keep) {
    StressConstants c = m_model.m_constitution.kernel().constants;
    c.keep_trial = keep;
    const double* inverse_V = m_model.m_inverse_V.data();
    const Index bad = with_law(m_model.m_constitution.kernel().law, [&](auto law) {
      return contact() ? stresses<Dim, decltype(law)::value, true>(c, first, last, inverse_V,
                                                                   m_H, m_P)
                       : stresses<Dim, decltype(law)::value, false>(c, first, last, inverse_V,
                                                                    m_H, m_P);
    });
    if (m_bad < 0) m_bad = bad;
  }

  /// P += J sigma_visc F^-T (62).
  void add_viscous_stress(Index first, Index last) {
    const Viscosity& viscosity = *m_model.m_viscosity;
    for (Index a = first; a < last; ++a) {
      const Mat3 P = viscosity.stress(tensor_of<Dim>(m_H.at(a)), tensor_of<Dim>(m_rate.at(a)));
      for (int j = 0; j < Dim; ++j) {
        for (int i = 0; i < Dim; ++i) m_P.at(a)[j * Lanes<Dim>::stride + i] += P(i, j);
      }
    }
  }

  DelaunayModel& m_model;
  const Reach& m_reach;
  const Bonds& m_bonds;
  const double *m_u, *m_v;
  Window<Dim> m_H, m_P, m_rate;
  ContactBuffer& m_buffer;
  ParticleRange m_part{0, 0};
  Index m_gradients = 0, m_stresses = 0;  ///< rows done
  Index m_opened_H = 0, m_opened_P = 0;   ///< records that have been opened
  Index m_bad = -1;
};

DelaunayModel::DelaunayModel(const Body& body, const scene::Problem& problem,
                             const Parameters& parameters, const Executor& executor)
    : ForceModel(body, problem), m_contact(parameters.xi_n > 0 || parameters.xi_t > 0),
      m_factors{parameters.xi_n * problem.material.E, parameters.xi_t * problem.material.mu},
      m_bonds(make_bonds(body, m_contact, executor)), m_reach(m_bonds.begin, m_bonds.other),
      m_viscosity(
          artificial_viscosity(parameters.c1, parameters.c2, problem.material, body.h_min)) {
  m_inverse_V.resize(body.n);
  for (Index a = 0; a < body.n; ++a) m_inverse_V[a] = 1 / body.V[a];
  provide_spaces(executor);
}

DelaunayModel::~DelaunayModel() = default;

void DelaunayModel::provide_spaces(const Executor& executor) {
  m_spaces.provide(executor.threads(), [&] {
    return std::make_unique<Space>(m_bonds, m_reach, m_body.dim, m_contact,
                                   m_viscosity.has_value());
  });
}

template <int Dim>
void DelaunayModel::forces_in(std::span<const ParticleRange> parts, const double* u,
                              const double* v, double* f, const Executor& executor) {
  provide_spaces(executor);
  FirstBad bad;
  m_spaces.for_parts(parts, executor, overlap(), [&](Space& space, ParticleRange part) {
    bad.tell(Sweep<Dim>(*this, space, u, v).forces(part, f));
  });
  bad.check();
}

void DelaunayModel::forces_of(std::span<const ParticleRange> parts, std::span<const double> u,
                              std::span<const double> v, std::span<double> f,
                              const Executor& executor) {
  if (m_body.dim == 3)
    forces_in<3>(parts, u.data(), v.data(), f.data(), executor);
  else
    forces_in<2>(parts, u.data(), v.data(), f.data(), executor);
}

void DelaunayModel::forces(std::span<const double> u, std::span<const double> v,
                           std::span<double> f, const Executor& executor) {
  const ParticleRange all{0, m_body.n};
  forces_of({&all, 1}, u, v, f, executor);
}

/// Rings of each loop beside a part, weighted by the loops' shares in a step (README):
/// gradients .22, contact and stress .61, forces .17; without contact .42, .20, .38.
Overlap DelaunayModel::overlap() const {
  const double ring = m_reach.mean();
  if (m_contact) return {(3 * .22 + 2 * .61 + .17) * ring, (2 * .22 + .61) * ring};
  return {(2 * .42 + .20 + .38) * ring, (.42 + .20) * ring};
}

ParticleRange DelaunayModel::reach(ParticleRange part) const {
  const auto ring = [&](ParticleRange r) {
    return ParticleRange{m_reach.bottom(r.first), m_reach.top(r.last)};
  };
  // f_a needs P_b of its neighbours, contact in it H_c of theirs, and H_c needs u_d of these'.
  return m_contact ? ring(ring(ring(part))) : ring(ring(part));
}

double DelaunayModel::viscous_damping_ratio(double omega_max) const {
  if (!m_viscosity) return 0;
  return m_viscosity->damping_ratio(m_constitution.kernel().constants.lame, omega_max);
}

/// use(first, last, H) for chunks of rows, on all threads; chunks start at multiples of
/// Reach::chunk.
template <int Dim, class Use>
void DelaunayModel::visit_gradients(const double* u, const Executor& executor, const Use& use) {
  provide_spaces(executor);
  const ParticleRange all{0, m_body.n};
  m_spaces.for_parts({&all, 1}, executor, {m_reach.mean(), 0},
                     [&](Space& space, ParticleRange part) {
                       Sweep<Dim>(*this, space, u, u).gradients(part, use);
                     });
}

void DelaunayModel::gradients(std::span<const double> u, std::span<Mat3> H) {
  const auto visit = [&]<int Dim>() {
    visit_gradients<Dim>(u.data(), Executor(1),
                         [&](Index first, Index last, Window<Dim> window) {
                           for (Index a = first; a < last; ++a)
                             H[a] = m_constitution.complete(tensor_of<Dim>(window.at(a)));
                         });
  };
  m_body.dim == 3 ? visit.template operator()<3>() : visit.template operator()<2>();
}

/// Contact energies (56) of the bonds in row a.
template <int Dim>
double DelaunayModel::contact_energies(const double* u, Window<Dim> H, Index a) const {
  constexpr std::size_t S = Lanes<Dim>::stride;
  const Tensor<Dim> H_a = Tensor<Dim>::load(H.at(a));
  const Vec<Dim> u_a = load<Vec<Dim>>(u + a * S), X_a = load<Vec<Dim>>(&m_body.X[a * S]);
  double energy = 0;
  for (Index k = m_bonds.begin[a]; k < m_bonds.begin[a + 1]; ++k) {
    const std::size_t b = m_bonds.other[k];
    const Vec<Dim> u_ab = load<Vec<Dim>>(u + b * S) - u_a,
                   X_ab = load<Vec<Dim>>(&m_body.X[b * S]) - X_a;
    Tensor<Dim> sum = Tensor<Dim>::load(H.at(m_bonds.other[k]));
    for (int i = 0; i < Dim; ++i) sum.column[i] += H_a.column[i];
    energy += contact_energy<Dim>(m_factors, m_bonds.area_over_length[k], X_ab, u_ab, sum);
  }
  return energy;
}

Energies DelaunayModel::energies(std::span<const double> u, const Executor& executor) {
  ChunkedEnergies energies(m_body.n);
  const auto visit = [&]<int Dim>() {
    visit_gradients<Dim>(u.data(), executor, [&](Index first, Index last, Window<Dim> H) {
      for (Index a = first; a < last; ++a) {
        energies.add(a, m_body.V[a], m_constitution.energy(a, tensor_of<Dim>(H.at(a))),
                     m_contact ? contact_energies<Dim>(u.data(), H, a) : 0.0);
      }
    });
  };
  m_body.dim == 3 ? visit.template operator()<3>() : visit.template operator()<2>();
  return energies.total();
}

/// Derivatives of (57), (58).
PairTangent DelaunayModel::contact_tangent(Index a, Index k, std::span<const double> u,
                                           std::span<const Mat3> H) const {
  PairTangent t;
  t.a = a;
  t.b = m_bonds.other[k];
  t.X_ab = m_body.position(t.b) - m_body.position(t.a);
  Vec3 u_ab = Vec3::Zero();
  for (int i = 0; i < m_body.dim; ++i) {
    u_ab[i] = u[static_cast<std::size_t>(t.b) * m_body.stride + i] -
              u[static_cast<std::size_t>(t.a) * m_body.stride + i];
  }
  const ContactLaw law = contact_law(m_factors, m_bonds.area_over_length[k], t.X_ab + u_ab,
                                     u_ab - 0.5 * (H[t.a] + H[t.b]) * t.X_ab);
  t.p_x = law.p_x, t.p_y = law.p_y, t.q_x = law.q_x, t.q_y = law.q_y;
  return t;
}

const ForceModel::Stiffness& DelaunayModel::tangent(std::span<const double> u) {
  if (!m_tangent) m_tangent.emplace(m_body, directed_rows(m_body, m_bonds));
  std::vector<Mat3> H(m_body.n);
  gradients(u, H);
  std::vector<Moduli> moduli(m_body.n);
  for (Index a = 0; a < m_body.n; ++a) moduli[a] = m_constitution.tangent(a, H[a]);
  std::vector<PairTangent> pairs;
  if (m_contact) {
    pairs.reserve(m_bonds.count());
    for (Index a = 0; a < m_body.n; ++a) {
      for (Index k = m_bonds.begin[a]; k < m_bonds.begin[a + 1]; ++k)
        pairs.push_back(contact_tangent(a, k, u, H));
    }
  }
  return m_tangent->assemble(moduli, pairs);
}

}  // namespace concord::particle::delaunay
