#pragma once
// One pass over the particles: mean gradients run ahead of gradients of faces and contact,
// these ahead of duals, and duals ahead of forces, each by what the rows of bonds reach.

#include "particle/core/sweeps.hpp"
#include "particle/core/viscosity.hpp"
#include "particle/voronoi/force_kernels.hpp"

#include <optional>

namespace concord::particle::voronoi {

/// What every sweep over a body reads.
template <int Dim> struct Setting {
  const Body& body;
  Bonds bonds;
  Ghosts<Dim> ghosts;
  Reach reach;
  std::vector<double> inverse_V;
  ContactFactors factors{0, 0};
  Form form = Form::face_compatible;
  std::optional<Viscosity> viscosity;  ///< (51)
  bool contact() const { return factors.any(); }
};

/// What one worker's sweep writes on the way: windows over particles, ghosts, buffers.
template <int Dim> class Space {
 public:
  explicit Space(const Setting<Dim>& s)
      : buffer(s.bonds.begin, Dim, s.contact()), m_near(s.reach.window(2) - 1),
        m_far(s.reach.window(s.contact() ? 3 : 2) - 1) {
    m_mean.assign((m_near + 1) * record_size<Dim>, 0.0);
    m_H = m_mean;
    m_Y.assign((m_far + 1) * record_size<Dim>, 0.0);
    m_ghost.assign(s.ghosts.count() * Lanes<Dim>::stride, 0.0);
    m_dual = m_ghost;
    if (!s.viscosity) return;
    m_mean_rate = m_rate = m_mean;
    m_ghost_rate = m_ghost;
  }
  Window<Dim> mean() { return {m_mean.data(), m_near}; }
  Window<Dim> H() { return {m_H.data(), m_near}; }
  Window<Dim> Y() { return {m_Y.data(), m_far}; }
  Window<Dim> mean_rate() { return {m_mean_rate.data(), m_near}; }
  Window<Dim> rate() { return {m_rate.data(), m_near}; }
  GhostVectors<Dim> ghosts() { return {m_ghost.data(), m_dual.data()}; }
  GhostVectors<Dim> ghost_rates() { return {m_ghost_rate.data(), m_dual.data()}; }

  ContactBuffer buffer;

 private:
  std::size_t m_near, m_far;
  Column m_mean, m_H, m_Y, m_mean_rate, m_rate, m_ghost, m_dual, m_ghost_rate;
};

/// The loops driven through a range of particles. Sweeps recompute what they share with others.
template <int Dim> class Sweep {
 public:
  Sweep(const Setting<Dim>& setting, const Constitution& constitution, Space<Dim>& space,
        const double* u, const double* v)
      : m_s(setting), m_constitution(constitution), m_space(space), m_u(u), m_v(v) {}

  /// f of the particles of `part` and of the boundary points on their cells. Returns the first
  /// particle met with det F <= 0 or NaN, or -1.
  Index forces(ParticleRange part, double* f) {
    m_part = part;
    m_f = f;
    Index done = m_s.reach.bottom(part.first);  // rows that add to the part's forces
    m_duals = m_opened_Y = m_s.reach.bottom(done);
    start_faces(m_s.reach.bottom(m_duals));
    while (done < part.last) {
      const Index last = std::min(done + Reach::chunk, part.last);
      duals_to(m_s.reach.top(last));
      by_ownership(m_part, done, last,
                   [&](Index first, Index end, bool own) { force(first, end, own); });
      done = last;
    }
    return m_bad;
  }

  /// use(first, last, mean, H, ghosts) for the particles of `part`, with H complete there and
  /// the mean gradients at the ends of their rows too.
  template <class Use> void gradients(ParticleRange part, const Use& use) {
    m_part = part;
    start_faces(m_s.reach.bottom(part.first));
    while (m_faces < part.last) {
      const Index first = m_faces;
      faces_to(first + 1);
      const Index from = std::max(first, part.first), to = std::min(m_faces, part.last);
      if (from < to) use(from, to, m_space.mean(), m_space.H(), m_space.ghosts());
    }
  }

 private:
  bool contact() const { return m_s.contact(); }
  bool viscous() const { return m_s.viscosity.has_value(); }
  bool face_form() const { return m_s.form == Form::face_compatible; }

  /// Gradients of faces are wanted from particle `first` on complete to their duals.
  void start_faces(Index first) {
    m_faces = m_opened = first;
    m_gradients = m_opened_mean = m_s.reach.bottom(first);
  }

  template <class F> void with_map(const F& f) const {
    if (m_s.ghosts.diagonal)
      f(DiagonalMap<Dim>{});
    else
      f(FullMap<Dim>{});
  }

  void gradients_to(Index last) {
    while (m_gradients < last) {
      const Index end = std::min(m_gradients + Reach::chunk, m_s.bonds.particles());
      const Index top = m_s.reach.top(end);
      if (top > m_opened_mean) {
        open_records<Dim>(m_space.mean(), m_opened_mean, top, m_u);
        open_ghosts<Dim>(m_s.ghosts, m_opened_mean, top, m_space.ghosts());
        if (viscous()) {
          open_records<Dim>(m_space.mean_rate(), m_opened_mean, top, m_v);
          open_ghosts<Dim>(m_s.ghosts, m_opened_mean, top, m_space.ghost_rates());
        }
        m_opened_mean = top;
      }
      const double *inverse_V = m_s.inverse_V.data(), *X = m_s.body.X.data();
      with_map([&]<class Map>(Map) {
        gradient_rows<Dim, Map>(m_s.bonds, m_s.ghosts, m_gradients, end, inverse_V, X, m_u,
                                m_space.mean(), m_space.ghosts());
        if (viscous())
          gradient_rows<Dim, Map>(m_s.bonds, m_s.ghosts, m_gradients, end, inverse_V, X, m_v,
                                  m_space.mean_rate(), m_space.ghost_rates());
      });
      m_gradients = end;
    }
  }

  /// H of the particles before `last`, and contact of their rows.
  void faces_to(Index last) {
    const double* X = m_s.body.X.data();
    while (m_faces < last) {
      const Index end = std::min(m_faces + Reach::chunk, m_s.bonds.particles());
      const Index top = m_s.reach.top(end);
      gradients_to(top);
      if (top > m_opened) {
        open_records<Dim>(m_space.H(), m_opened, top, X);
        if (contact()) open_records<Dim>(m_space.Y(), m_opened, top);
        if (viscous()) open_records<Dim>(m_space.rate(), m_opened, top, X);
        m_opened = top;
      }
      if (face_form()) {
        contact() ? faces<true, true>(end) : faces<false, true>(end);
      } else {
        contact() ? faces<true, false>(end) : faces<false, false>(end);
      }
      m_faces = end;
    }
  }

  template <bool Contact, bool Faces> void faces(Index end) {
    const double* inverse_V = m_s.inverse_V.data();
    face_rows<Dim, Contact, Faces>(m_s.bonds, m_s.ghosts, m_faces, end, inverse_V, m_u,
                                   m_s.factors, m_space.mean(), m_space.H(), m_space.Y(),
                                   m_space.ghosts(), m_space.buffer);
    if (viscous())
      face_rows<Dim, false, Faces>(m_s.bonds, m_s.ghosts, m_faces, end, inverse_V, m_v,
                                   m_s.factors, m_space.mean_rate(), m_space.rate(),
                                   m_space.Y(), m_space.ghost_rates(), m_space.buffer);
  }

  /// P in place of H for the particles before `last`.
  void stresses_to(Index last) {
    while (m_faces < last) {
      const Index first = m_faces;
      faces_to(first + 1);
      by_ownership(m_part, first, m_faces,
                   [&](Index from, Index end, bool own) { stress(from, end, own); });
    }
  }

  /// Only the part's own particles keep a plastic trial state.
  void stress(Index first, Index last, bool keep) {
    StressConstants c = m_constitution.kernel().constants;
    c.keep_trial = keep;
    if (viscous()) viscous_stress(first, last);
    const Index bad = with_law(m_constitution.kernel().law, [&](auto law) {
      return stresses<Dim, decltype(law)::value>(c, first, last, m_space.H());
    });
    if (m_bad < 0) m_bad = bad;
    if (!viscous()) return;
    for (Index a = first; a < last; ++a) {
      Tensor<Dim> P = Tensor<Dim>::load(m_space.H().at(a));
      const Tensor<Dim> more = Tensor<Dim>::load(m_space.rate().at(a));
      for (int k = 0; k < Dim; ++k) P.column[k] += more.column[k];
      P.store(m_space.H().at(a));
    }
  }

  /// J sigma_visc F^-T (51) in place of the rate.
  void viscous_stress(Index first, Index last) {
    const Viscosity& viscosity = *m_s.viscosity;
    for (Index a = first; a < last; ++a) {
      const Mat3 P = viscosity.stress(tensor_of<Dim>(m_space.H().at(a)),
                                      tensor_of<Dim>(m_space.rate().at(a)));
      for (int j = 0; j < Dim; ++j) {
        for (int i = 0; i < Dim; ++i)
          m_space.rate().at(a)[j * Lanes<Dim>::stride + i] = P(i, j);
      }
    }
  }

  void duals_to(Index last) {
    while (m_duals < last) {
      const Index end = std::min(m_duals + Reach::chunk, m_s.bonds.particles());
      const Index top = m_s.reach.top(end);
      stresses_to(top);
      if (!contact() && top > m_opened_Y) {
        open_records<Dim>(m_space.Y(), m_opened_Y, top);
        m_opened_Y = top;
      }
      by_ownership(m_part, m_duals, end,
                   [&](Index first, Index to, bool own) { dual(first, to, own); });
      m_duals = end;
    }
  }

  void dual(Index first, Index last, bool own) {
    const PointForces points{own ? m_f : nullptr};
    const auto rows = [&]<Form form>() {
      dual_rows<Dim, form>(m_s.bonds, m_s.ghosts, first, last, m_s.inverse_V.data(),
                           m_space.H(), m_space.Y(), m_space.ghosts(), points);
    };
    switch (m_s.form) {
      case Form::face_compatible:
        return rows.template operator()<Form::face_compatible>();
      case Form::conserving:
        return rows.template operator()<Form::conserving>();
      case Form::quasi_static:
        return rows.template operator()<Form::quasi_static>();
    }
  }

  void force(Index first, Index last, bool own) {
    with_map([&]<class Map>(Map) {
      force_rows<Dim, Map>(m_s.bonds, m_s.ghosts, first, last, m_s.body.X.data(), m_space.Y(),
                           m_space.ghosts(), face_form(), PointForces{own ? m_f : nullptr});
    });
    if (own) copy_vectors<Dim>(m_space.Y(), first, last, m_f);
  }

  const Setting<Dim>& m_s;
  const Constitution& m_constitution;
  Space<Dim>& m_space;
  const double *m_u, *m_v;
  double* m_f = nullptr;
  ParticleRange m_part{0, 0};
  Index m_gradients = 0, m_faces = 0, m_duals = 0;        ///< rows done
  Index m_opened_mean = 0, m_opened = 0, m_opened_Y = 0;  ///< records that have been opened
  Index m_bad = -1;
};

}  // namespace concord::particle::voronoi
