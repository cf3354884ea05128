#include "particle/delaunay/fracture_sweep.hpp"

#include "particle/core/reach.hpp"
#include "particle/delaunay/fracture_kernels.hpp"

namespace concord::particle::delaunay {
namespace {

constexpr Index chunk = Reach::chunk;

/// Rows are done in whole chunks, so that the pressures of a chunk's bonds stand together from
/// the gradients to the forces.
template <int Dim> class SweepIn final : public FractureSweep {
 public:
  SweepIn(const Body& body, const Network& network, const BreakingLaw& law)
      : m_body(body), m_network(network), m_law(law), m_contact(law.contact.any()),
        m_reach(network.rows().begin, network.rows().other), m_mask(m_reach.window(2) - 1),
        m_slots(m_reach.window(3) / chunk + 2), m_buffer(network.rows().begin, Dim, m_contact) {
    m_H.assign((m_mask + 1) * record_size<Dim>, 0.0);
    if (m_contact) m_Q = m_H;
    m_stresses.assign((m_mask + 1) * stress_record<Dim>, 0.0);
    const std::vector<Index>& begin = network.rows().begin;
    for (Index a = 0; a < body.n; a += chunk)
      m_most = std::max<std::size_t>(m_most, begin[std::min(body.n, a + chunk)] - begin[a]);
    m_most = (m_most + 3) / 4 * 4;
    m_lengths.assign(m_most, 0.0);
    m_minus_pi.assign(m_slots * m_most, 0.0);
    m_works.assign(law.by_energy ? m_most : 0, 0.0);
    for (Index k = 0; k < static_cast<Index>(network.bonds()); ++k) {
      const auto [a, b] = network.ends(k);
      m_places.push_back({stresses().place(a), stresses().place(b)});
      for (int i = 0; i < Dim; ++i)
        m_X_ab[i].push_back(body.position(b)[i] - body.position(a)[i]);
    }
  }

  Index forces(ParticleRange part, const double* u, const double* v, double* f, double* viscous,
               std::vector<Index>* failed) override {
    m_u = u, m_v = v, m_failed = failed, m_bad = -1;
    Index done = start_of_chunk(m_reach.bottom(part.first));
    m_stressed = m_opened_Q = m_contact ? start_of_chunk(m_reach.bottom(done)) : done;
    start_gradients(m_stressed);
    std::size_t skew = skew_before_row<Dim>(m_network, done), skew_of_works = skew;
    for (; done < part.last; done = std::min(done + chunk, m_body.n)) {
      const Index end = std::min(done + chunk, m_body.n);
      stresses_to(m_reach.top(end));
      if (m_law.by_energy && m_failed != nullptr) check_works(done, end, skew_of_works);
      breakable_forces<Dim>(SomeBonds<Dim>(m_network, m_places, done, end, skew),
                            pressures_of(done), stresses());
      copy_forces<Dim>(stresses(), std::max(done, part.first), std::min(end, part.last), f,
                       viscous);
    }
    return m_bad;
  }

  void gradients(const double* u, const Use& use) override {
    m_u = m_v = u, m_failed = nullptr;
    start_gradients(0);
    for (Index first = 0; first < m_body.n; first += chunk) {
      const Index last = std::min(first + chunk, m_body.n);
      gradients_to(last);
      for (Index a = first; a < last; ++a) use(a, tensor_of<Dim>(H().at(a)));
    }
  }

  ParticleRange influence(Index a) const override {
    const auto ring = [&](ParticleRange r) {
      return ParticleRange{m_reach.bottom(r.first), m_reach.top(r.last)};
    };
    // f needs P of the neighbours, contact in it H of theirs.
    return m_contact ? ring(ring({a, a + 1})) : ring({a, a + 1});
  }

 private:
  static Index start_of_chunk(Index a) { return a / chunk * chunk; }
  Window<Dim> H() { return {m_H.data(), m_mask}; }
  Window<Dim> Q() { return {m_Q.data(), m_mask}; }
  StressWindow<Dim> stresses() { return {m_stresses.data(), m_mask}; }
  double* pressures_of(Index first) { return &m_minus_pi[first / chunk % m_slots * m_most]; }
  const double* inverse_omega() const { return m_network.inverse_omega().data(); }
  const double* X() const { return m_body.X.data(); }

  void start_gradients(Index first) {
    m_graded = m_opened_H = start_of_chunk(m_reach.bottom(first));
    m_skew_graded = skew_before_row<Dim>(m_network, m_graded);
  }

  void gradients_to(Index last) {
    while (m_graded < last) {
      const Index first = m_graded, end = std::min(first + chunk, m_body.n),
                  top = m_reach.top(end);
      if (top > m_opened_H) {
        open_motion<Dim>(H(), m_opened_H, top, m_u, m_v);
        m_opened_H = top;
      }
      const double excess = breakable_gradients<Dim>(
          SomeBonds<Dim>(m_network, m_places, first, end, m_skew_graded), m_v, H(),
          pressures(first));
      divide_by_omega<Dim>(first, end, inverse_omega(), H());
      if (excess >= 0) find_failed(first, end);
      m_graded = end;
    }
  }

  BondPressures<Dim> pressures(Index first_row) {
    const Index first = m_network.rows().begin[first_row];
    BondPressures<Dim> p;
    for (int i = 0; i < Dim; ++i) p.X[i] = m_X_ab[i].data() + first;
    p.limit = m_law.limit.data() + first;
    p.viscosity = m_law.viscosity;
    p.softening = m_law.softening;
    p.minus_pi = pressures_of(first_row);
    p.lengths = m_lengths.data();
    return p;
  }

  /// Which bonds of rows are too long.
  void find_failed(Index first, Index last) {
    if (m_failed == nullptr || m_law.by_energy) return;
    const std::vector<Index>& begin = m_network.rows().begin;
    for (Index k = begin[first]; k < begin[last]; ++k) {
      if (m_lengths[k - begin[first]] >= m_law.limit[k]) m_failed->push_back(k);
    }
  }

  void check_works(Index first, Index last, std::size_t& skew) {
    const std::vector<Index>& begin = m_network.rows().begin;
    const double* limit = m_law.limit.data() + begin[first];
    const double excess =
        bond_works<Dim>(SomeBonds<Dim>(m_network, m_places, first, last, skew), X(), m_u,
                        stresses(), limit, m_works.data());
    if (excess < 0) return;
    for (Index k = 0; k < begin[last] - begin[first]; ++k) {
      if (m_works[k] >= limit[k]) m_failed->push_back(begin[first] + k);
    }
  }

  void stresses_to(Index last) {
    while (m_stressed < last) {
      const Index end = std::min(m_stressed + chunk, m_body.n), top = m_reach.top(end);
      gradients_to(m_contact ? top : end);
      if (m_contact) {
        if (top > m_opened_Q) open_records<Dim>(Q(), m_opened_Q, top);
        m_opened_Q = std::max(m_opened_Q, top);
        contact_rows<Dim>(m_network.rows(), m_stressed, end, m_law.contact, X(), H(), Q(),
                          m_buffer);
      }
      const StressConstants& c = m_law.material.constants;
      const Index bad = with_law(m_law.material.law, [&](auto law) {
        constexpr StressLaw Law = decltype(law)::value;
        const auto loop = m_contact ? breakable_stresses<Dim, Law, true>
                                    : breakable_stresses<Dim, Law, false>;
        return loop(c, m_stressed, end, inverse_omega(), H(), Q(), stresses());
      });
      if (m_bad < 0) m_bad = bad;
      m_stressed = end;
    }
  }

  const Body& m_body;
  const Network& m_network;
  const BreakingLaw& m_law;
  bool m_contact;
  Reach m_reach;
  std::size_t m_mask, m_slots, m_most = 0;
  ContactBuffer m_buffer;
  std::vector<Places> m_places;     ///< of every bond
  std::vector<double> m_X_ab[Dim];  ///< components of every bond
  Column m_H, m_Q, m_stresses;      ///< records of the windows
  Column m_lengths, m_works;        ///< of a chunk's bonds
  Column m_minus_pi;                ///< of chunks between gradients and forces
  const double *m_u = nullptr, *m_v = nullptr;
  std::vector<Index>* m_failed = nullptr;
  Index m_graded = 0, m_stressed = 0;    ///< rows done
  Index m_opened_H = 0, m_opened_Q = 0;  ///< records that have been opened
  std::size_t m_skew_graded = 0;         ///< skew bonds before the rows that are done
  Index m_bad = -1;
};

}  // namespace

std::unique_ptr<FractureSweep> FractureSweep::make(const Body& body, const Network& network,
                                                   const BreakingLaw& law) {
  if (body.dim == 3) return std::make_unique<SweepIn<3>>(body, network, law);
  return std::make_unique<SweepIn<2>>(body, network, law);
}

}  // namespace concord::particle::delaunay
