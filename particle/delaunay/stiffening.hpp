#pragma once
// How high frequencies may have risen where simplices went: mass stays, Omega_i shrinks.

#include "particle/core/constitution.hpp"
#include "particle/core/contact.hpp"
#include "particle/core/fracturing.hpp"
#include "particle/delaunay/network.hpp"

namespace concord::particle::delaunay {

/// The energy is a sum over particles i, each a function of the points p of its own sum. With
/// shares of the points' masses, sum_i s_ip = 1, and any split of the energy,
///   omega^2 <= max_i omega_i^2,   omega_i of the points of i alone, with masses s_ip m_p
/// (B. M. Irons, G. Treharne, Proc. 3rd Conf. on Matrix Methods in Structural Mechanics, 1971).
/// README.md, (DEL.10), (DEL.11), has the shares and omega_i.
class Stiffening {
 public:
  /// References must outlive the object. Of the network as it is now; O(particles).
  Stiffening(const Body& body, const Network& network, const Constitution& constitution,
             const ContactFactors& contact);

  /// The largest omega_i about u of all particles whose shares or sums have changed by a
  /// removal at the particles `touched` (ascending).
  FrequencyBound near(const std::vector<Index>& touched, std::span<const double> u);

 private:
  /// A particle's sum, and its contact's matrix over the same points.
  struct Element {
    Stencil sum;
    Eigen::MatrixXd contact;
    std::vector<double> weight;  ///< of its points, for their shares
  };
  Element element(Index particle) const;
  double contact_over_length(Index a, Index b) const;
  double omega_squared(Index particle, const Element& e, std::span<const double> u) const;

  const Body& m_body;
  const Network& m_network;
  const Constitution& m_constitution;
  ContactFactors m_contact;
  double m_modulus;              ///< lambda + 2 mu [Pa]
  std::vector<double> m_weight;  ///< sum of the weights at a point [N/m]
};

}  // namespace concord::particle::delaunay
