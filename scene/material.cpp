#include "scene/material.hpp"

namespace concord::scene {

double Material::longitudinal_wave_speed() const { return std::sqrt((lambda + 2 * mu) / rho0); }
double Material::shear_wave_speed() const { return std::sqrt(mu / rho0); }

Tangent NeoHookean::tangent(const Mat3& H) const {
  const Mat3 G = inverse_transpose<double>(H + Mat3::Identity());
  const double c = mu - lambda * log_one_plus(volume_change(H));
  Tangent A;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l)
          A(3 * i + j, 3 * k + l) =
              (i == k && j == l ? mu : 0) + lambda * G(i, j) * G(k, l) + c * G(i, l) * G(k, j);
  return A;
}

Tangent NeoHookeanIsochoric::tangent(const Mat3& H) const {
  const Mat3 F = H + Mat3::Identity();
  const Mat3 G = inverse_transpose<double>(F);
  const double dJ = volume_change(H), kappa = bulk_modulus();
  const double c = mu * std::exp(-2.0 / 3 * log_one_plus(dJ)), c_tr_C = c * F.squaredNorm();
  const double g = 2.0 / 9 * c_tr_C + kappa * (1 + dJ) * (1 + dJ);
  const double t = c_tr_C / 3 - 0.5 * kappa * dJ * (2 + dJ);
  Tangent A;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l)
          A(3 * i + j, 3 * k + l) = (i == k && j == l ? c : 0) -
                                    2.0 / 3 * c * (F(i, j) * G(k, l) + G(i, j) * F(k, l)) +
                                    g * G(i, j) * G(k, l) + t * G(i, l) * G(k, j);
  return A;
}

Tangent StVenantKirchhoff::tangent(const Mat3& H) const {
  const Mat3 F = H + Mat3::Identity();
  const Mat3 S = second_piola(H);
  const Mat3 B = F * F.transpose();
  Tangent A;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l)
          A(3 * i + j, 3 * k + l) = (i == k ? S(j, l) : 0) + lambda * F(i, j) * F(k, l) +
                                    mu * ((j == l ? B(i, k) : 0) + F(i, l) * F(k, j));
  return A;
}

ElasticLaw::ElasticLaw(const Material& material, Dimension dimension)
    : m_model(material.model), m_dimension(dimension), m_lambda(material.lambda),
      m_mu(material.mu) {}

Mat3 ElasticLaw::complete(const Mat3& H) const {
  if (m_dimension == Dimension::three_d) return H;
  Mat3 full = Mat3::Zero();
  full.topLeftCorner<2, 2>() = H.topLeftCorner<2, 2>();
  if (m_dimension == Dimension::plane_stress)
    full(2, 2) = with_model([&](const auto& law) { return law.plane_stress_stretch(full); });
  return full;
}

double ElasticLaw::energy(const Mat3& H) const {
  const Mat3 full = complete(H);
  return with_model([&](const auto& law) { return law.energy(full); });
}

Mat3 ElasticLaw::stress(const Mat3& H) const {
  const Mat3 full = complete(H);
  return with_model([&](const auto& law) { return law.stress(full); });
}

Tangent ElasticLaw::tangent(const Mat3& H) const {
  const Mat3 full = complete(H);
  Tangent A = with_model([&](const auto& law) { return law.tangent(full); });
  if (m_dimension != Dimension::plane_stress) return A;
  const Eigen::Matrix<double, 9, 1> column = A.col(8);
  const Eigen::Matrix<double, 1, 9> row = A.row(8);
  const double A3333 = A(8, 8);
  A -= column * row / A3333;
  A.row(8).setZero();
  A.col(8).setZero();
  return A;
}

Mat3 cauchy_stress(const Mat3& P, const Mat3& F) { return P * F.transpose() / F.determinant(); }

double von_mises(const Mat3& sigma) {
  const Mat3 s = sigma - sigma.trace() / 3 * Mat3::Identity();
  return std::sqrt(1.5) * s.norm();
}

double pressure(const Mat3& sigma) { return -sigma.trace() / 3; }

}  // namespace concord::scene
