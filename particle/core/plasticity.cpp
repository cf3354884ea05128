// Equations (PLA.n): README.md of this folder.

#include "particle/core/plasticity.hpp"

#include "particle/core/plasticity_plane.hpp"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>
#include <utility>

namespace concord::particle {

namespace {

constexpr double round_off = std::numeric_limits<double>::epsilon();

/// Elastic logarithmic strain e = 1/2 ln(F C_p^-1 F^T) before plastic flow.
struct TrialStrain {
  Mat3 metric;        ///< F F^T - I
  double log_J = 0;   ///< tr e: plastic flow keeps the volume
  Vec3 deviator;      ///< principal values of dev e
  Mat3 axes;          ///< principal directions, columns
  bool sound = true;  ///< false: det F <= 0 or not a number
};

/// Where 3 is a principal direction. With b_1, b_2 = D exp(+-d) in the plane, D^2 = b_1 b_2 =
/// J^2/b_33, d = e_1 - e_2 = asinh((b_1 - b_2)/(2 D)): no eigenvalue is subtracted from
/// another, neither at small strains nor at large ones.
void decompose_plane(const Mat3& x, double J, TrialStrain& trial) {
  const double half = 0.5 * (x(0, 0) - x(1, 1)), shear = x(0, 1);
  const double r = std::hypot(half, shear);  // (b_1 - b_2)/2
  const double d = std::asinh(r * std::sqrt(1 + x(2, 2)) / J);
  const double v = 0.5 * std::log1p(x(2, 2)) - trial.log_J / 3;
  trial.deviator << 0.5 * (d - v), -0.5 * (d + v), v;
  double c = 1, s = 0;  // cos 2t = half/r, sin 2t = shear/r
  if (half > 0) {
    c = std::sqrt(0.5 * (1 + half / r));
    s = 0.5 * shear / (r * c);
  } else if (r > 0) {
    s = std::copysign(std::sqrt(0.5 * (1 - half / r)), shear);
    c = 0.5 * shear / (r * s);
  }
  trial.axes << c, -s, 0, s, c, 0, 0, 0, 1;
}

/// The eigenvalues carry the round-off of the largest, so the smallest takes its logarithm from
/// det b_e = J^2.
void decompose_space(const Mat3& x, TrialStrain& trial) {
  Eigen::SelfAdjointEigenSolver<Mat3> solver;
  solver.compute(x);
  const Vec3& value = solver.eigenvalues();  // ascending
  const double mean = trial.log_J / 3;
  trial.deviator(2) = 0.5 * std::log1p(value(2)) - mean;
  trial.deviator(1) = 0.5 * std::log1p(value(1)) - mean;
  trial.deviator(0) = -trial.deviator(1) - trial.deviator(2);
  trial.axes = solver.eigenvectors();
}

/// (PLA.1), (PLA.2): small strains keep their relative accuracy.
TrialStrain trial_strain(const Mat3& H, const Mat3& A) {
  TrialStrain trial;
  const double j = scene::volume_change(H);
  trial.sound = j > -1.0 && std::isfinite(j);
  if (!trial.sound) return trial;
  trial.log_J = std::log1p(j);
  trial.metric = H + H.transpose() + H * H.transpose();
  const Mat3 F = H + Mat3::Identity();
  Mat3 x = trial.metric + F * A * F.transpose();
  x = 0.5 * (x + x.transpose()).eval();
  if (!x.allFinite()) {
    trial.sound = false;
    return trial;
  }
  if (x(0, 2) == 0 && x(1, 2) == 0)
    decompose_plane(x, 1 + j, trial);
  else
    decompose_space(x, trial);
  trial.sound = trial.deviator.allFinite();
  return trial;
}

/// sqrt(3/2) |dev tau| of dev tau = 2 mu dev e.
double equivalent_stress(double mu, const Vec3& deviator) {
  return mu * std::sqrt(6.0) * deviator.norm();
}

/// (PLA.4), C_p^-1 - I = F^-1 b_e F^-T - I. Near the identity the strains are subtracted, F^-1
/// ((b_e - I) - (F F^T - I)) F^-T; where F F^T is not near I, that would cancel.
Mat3 plastic_metric(const TrialStrain& trial, const Vec3& e, const Mat3& G) {
  const bool far = trial.metric.cwiseAbs().maxCoeff() > 0.5;
  Vec3 b;
  for (int i = 0; i < 3; ++i) b(i) = far ? std::exp(2 * e(i)) : std::expm1(2 * e(i));
  Mat3 s = trial.axes * b.asDiagonal() * trial.axes.transpose();
  if (!far) s -= trial.metric;
  Mat3 A = G.transpose() * s * G;
  A = 0.5 * (A + A.transpose()).eval();
  if (far) A -= Mat3::Identity();
  return A;
}

/// x/(e^x - 1).
double bernoulli(double x) { return x == 0 ? 1.0 : x / std::expm1(x); }

}  // namespace

J2Hencky::J2Hencky(const scene::Material& material)
    : m_mu(material.mu), m_kappa(material.lambda + 2 * material.mu / 3),
      m_hardening(material.hardening) {}

double J2Hencky::flow_stress(double eps_p) const {
  const scene::Hardening& h = m_hardening;
  return h.yield_stress + h.modulus * eps_p -
         (h.saturation_stress - h.yield_stress) * std::expm1(-h.exponent * eps_p);
}

double J2Hencky::flow_slope(double eps_p) const {
  const scene::Hardening& h = m_hardening;
  return h.modulus +
         (h.saturation_stress - h.yield_stress) * h.exponent * std::exp(-h.exponent * eps_p);
}

double J2Hencky::flow_energy(double eps_p) const {
  const scene::Hardening& h = m_hardening;
  double energy = (h.yield_stress + 0.5 * h.modulus * eps_p) * eps_p;
  if (h.exponent > 0) {
    const double x = h.exponent * eps_p;
    energy += (h.saturation_stress - h.yield_stress) * (x + std::expm1(-x)) / h.exponent;
  }
  return energy;
}

double J2Hencky::plastic_increment(double trial, double eps_p) const {
  double low = 0, high = trial / (3 * m_mu), d = 0;
  for (int it = 0; it < 200; ++it) {
    const double g = trial - 3 * m_mu * d - flow_stress(eps_p + d);
    if (std::abs(g) <= 2 * round_off * trial) break;
    (g > 0 ? low : high) = d;
    double next = d + g / (3 * m_mu + flow_slope(eps_p + d));
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    if (next == d) break;
    d = next;
  }
  return d;
}

J2Hencky::Update J2Hencky::update(const Mat3& H, const PlasticState& old) const {
  Update u;
  u.state = old;
  const TrialStrain trial = trial_strain(H, old.A);
  u.sound = trial.sound;
  if (!u.sound) return u;
  const double q = equivalent_stress(m_mu, trial.deviator);
  u.tau_eq = q;
  u.yields = q > flow_stress(old.eps_p);
  Vec3 deviator = trial.deviator;
  const Mat3 G = scene::inverse_transpose(Mat3(H + Mat3::Identity()));
  if (u.yields) {
    u.state.eps_p = old.eps_p + plastic_increment(q, old.eps_p);  // (PLA.3)
    u.tau_eq = flow_stress(u.state.eps_p);
    deviator *= u.tau_eq / q;
    u.state.A = plastic_metric(trial, deviator + Vec3::Constant(trial.log_J / 3), G);
  }
  const Vec3 tau = 2 * m_mu * deviator + Vec3::Constant(m_kappa * trial.log_J);
  u.P = trial.axes * tau.asDiagonal() * trial.axes.transpose() * G;  // (PLA.5)
  u.stored = 0.5 * m_kappa * trial.log_J * trial.log_J + m_mu * deviator.squaredNorm();
  u.plastic = flow_energy(u.state.eps_p);
  u.sound = u.P.allFinite() && u.state.A.allFinite();
  return u;
}

/// With l = dF F^-1 in principal axes, b_i = exp(2 e_i): de_ij = 1/2 (f(2 e_i - 2 e_j) l_ij +
/// f(2 e_j - 2 e_i) l_ji), f(x) = x/(e^x - 1), at equal b_i too. Return map: d dev tau =
/// 2 mu (beta dev de - c N N:de), N = dev e/|dev e|, beta = tau_y/q, c = 3 mu/(3 mu + tau_y') -
/// 3 mu d/q. dP = (d tau - tau l^T) F^-T.
scene::Tangent J2Hencky::tangent(const Mat3& H, const PlasticState& old) const {
  const TrialStrain trial = trial_strain(H, old.A);
  if (!trial.sound) return scene::Tangent::Constant(std::numeric_limits<double>::quiet_NaN());
  const double q = equivalent_stress(m_mu, trial.deviator), yield = flow_stress(old.eps_p);
  double beta = 1, c = 0;
  if (q > yield || (old.eps_p > 0 && q >= (1 - 1e-9) * yield)) {
    const double d = q > yield ? plastic_increment(q, old.eps_p) : 0;
    beta = d > 0 ? flow_stress(old.eps_p + d) / q : 1;
    c = 3 * m_mu / (3 * m_mu + flow_slope(old.eps_p + d)) - 3 * m_mu * d / q;
  }
  const Vec3& e = trial.deviator;
  const double norm = e.norm();
  const Vec3 N = norm > 0 ? Vec3(e / norm) : Vec3::Zero();
  Mat3 f;
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) f(i, k) = 0.5 * bernoulli(2 * (e(i) - e(k)));
  const Mat3& Q = trial.axes;
  const Vec3 tau = 2 * m_mu * beta * e + Vec3::Constant(m_kappa * trial.log_J);
  const Mat3 G = scene::inverse_transpose(Mat3(H + Mat3::Identity()));
  const Mat3 QG = Q.transpose() * G;
  scene::Tangent T;
  for (int k = 0; k < 9; ++k) {  // dF = unit tensor (k / 3, k % 3)
    const Mat3 l = Q.row(k / 3).transpose() * QG.col(k % 3).transpose();
    Mat3 dtau = 2 * m_mu * beta * (f.cwiseProduct(l) + f.cwiseProduct(l).transpose());
    const double trace = l.trace();
    dtau.diagonal().array() += (m_kappa - 2 * m_mu * beta / 3) * trace;
    dtau.diagonal() -= 2 * m_mu * c * N.dot(l.diagonal()) * N;
    const Mat3 dP = Q * (dtau - tau.asDiagonal() * l.transpose()) * QG;
    for (int r = 0; r < 9; ++r) T(r, k) = dP(r / 3, r % 3);
  }
  return T;
}

PlasticHistory::PlasticHistory(const scene::Problem& problem, Index n)
    : m_material(problem.material), m_law(problem.material), m_n(n),
      m_components(problem.dim() == 3 ? 6 : 4) {
  const std::size_t padded = static_cast<std::size_t>(n) + plastic_width;
  m_old.assign(static_cast<std::size_t>(m_components) + 1, Column(padded, 0.0));
  m_new = m_old;
}

PlasticState PlasticHistory::committed(Index a) const {
  assert(a >= 0 && a < m_n);
  const auto i = static_cast<std::size_t>(a);
  PlasticState state;
  for (int k = 0; k < 3; ++k) state.A(k, k) = m_old[k][i];
  state.A(0, 1) = state.A(1, 0) = m_old[3][i];
  if (m_components == 6) {
    state.A(1, 2) = state.A(2, 1) = m_old[4][i];
    state.A(2, 0) = state.A(0, 2) = m_old[5][i];
  }
  state.eps_p = m_old[m_components][i];
  return state;
}

template <int Dim>
void PlasticHistory::stress_of(Index first, int lane,
                               const double (&h)[Dim * Dim][plastic_width],
                               double (&p)[Dim * Dim][plastic_width],
                               double (&j)[plastic_width], bool keep) {
  const Index a = first + lane;
  Mat3 H = Mat3::Zero();
  for (int k = 0; k < Dim * Dim; ++k) H(k % Dim, k / Dim) = h[k][lane];
  const J2Hencky::Update u = m_law.update(H, committed(a));
  if (keep) {
    for (int k = 0; k < 3; ++k) m_new[k][a] = u.state.A(k, k);
    m_new[3][a] = u.state.A(0, 1);
    if constexpr (Dim == 3) m_new[4][a] = u.state.A(1, 2), m_new[5][a] = u.state.A(2, 0);
    m_new[m_components][a] = u.state.eps_p;
  }
  for (int k = 0; k < Dim * Dim; ++k) p[k][lane] = u.P(k % Dim, k / Dim);
  j[lane] = u.sound ? scene::volume_change(H) : std::numeric_limits<double>::quiet_NaN();
}

/// Several threads evaluate at once, each its particles.
void PlasticHistory::note_trial() {
  const std::atomic_ref has_trial(m_has_trial);
  if (!has_trial.load(std::memory_order_relaxed))
    has_trial.store(true, std::memory_order_relaxed);
}

void PlasticHistory::stress(Index first, int count, const double (&h)[9][plastic_width],
                            double (&p)[9][plastic_width], double (&j)[plastic_width],
                            bool keep) {
  assert(first >= 0 && first + count <= m_n);
  if (keep) note_trial();
  for (int l = 0; l < count; ++l) stress_of<3>(first, l, h, p, j, keep);
}

void PlasticHistory::stress(Index first, int count, const double (&h)[4][plastic_width],
                            double (&p)[4][plastic_width], double (&j)[plastic_width],
                            bool keep) {
  assert(first >= 0 && first + count <= m_n);
  if (keep) note_trial();
  PlaneStates old, next;
  double(*const from[])[plastic_width] = {&old.A11, &old.A22, &old.A33, &old.A12, &old.eps_p};
  for (int k = 0; k < 5; ++k)  // the columns are padded by a group
    std::copy_n(m_old[k].data() + first, plastic_width, *from[k]);
  unsigned beyond = plane_lanes(
      {m_law.shear_modulus(), m_law.bulk_modulus(), m_law.hardening()}, h, old, next, p, j);
  const double(*const to[])[plastic_width] = {&next.A11, &next.A22, &next.A33, &next.A12,
                                              &next.eps_p};
  for (int k = 0; keep && k < 5; ++k) std::copy_n(*to[k], count, m_new[k].data() + first);
  for (beyond &= (1u << count) - 1; beyond != 0; beyond &= beyond - 1)
    stress_of<2>(first, std::countr_zero(beyond), h, p, j, keep);
}

void PlasticHistory::hold(bool on) {
  scene::Material material = m_material;
  constexpr double never = 1e300;  // [Pa] no stress reaches it
  if (on) material.hardening = {never, never, 0, 0};
  m_law = J2Hencky(material);
}

void PlasticHistory::commit() {
  if (!m_has_trial) return;  // a second commit changes nothing
  std::swap(m_old, m_new);
  m_has_trial = false;
}

}  // namespace concord::particle
