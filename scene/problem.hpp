#pragma once
// The one problem statement that every method receives. Plain data in SI units, checked by the
// reader.

#include "scene/errors.hpp"
#include "scene/expression.hpp"
#include "scene/types.hpp"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace concord::scene {

/// Stress laws; energies and sources in material.hpp. j2_hencky: finite-strain J2 plasticity
/// with logarithmic strains and Kirchhoff stress, Algorithm 2 of the Continuum Bond Method
/// paper.
enum class MaterialModel { neo_hookean, neo_hookean_isochoric, st_venant_kirchhoff, j2_hencky };

/// Isotropic hardening, Eq. (24) of the Continuum Bond Method paper: flow stress
/// tau_y(eps_p) = yield_stress + modulus eps_p + (saturation_stress - yield_stress)(1 -
/// exp(-exponent eps_p)).
struct Hardening {
  double yield_stress = 0;       ///< tau_y0 [Pa], > 0
  double saturation_stress = 0;  ///< tau_y,inf [Pa], > 0
  double modulus = 0;            ///< h_0 [Pa]
  double exponent = 0;           ///< alpha, >= 0
};

/// Isotropic elastic constants and density of the homogeneous body.
struct Material {
  MaterialModel model = MaterialModel::neo_hookean;
  double rho0 = 0;      ///< reference density [kg/m^3]
  double E = 0;         ///< Young's modulus [Pa]
  double nu = 0;        ///< Poisson's ratio, -1 < nu < 0.5
  double lambda = 0;    ///< Lame's first parameter [Pa], Eq. (54) of the Delaunay paper
  double mu = 0;        ///< shear modulus [Pa]
  Hardening hardening;  ///< of plastic models
  bool plastic() const { return model == MaterialModel::j2_hencky; }
  double longitudinal_wave_speed() const;  ///< c_p = sqrt((lambda + 2 mu)/rho0) [m/s], Eq. (55)
  double shear_wave_speed() const;         ///< c_s = sqrt(mu/rho0) [m/s]
};

enum class BoundaryKind {
  fixed,      ///< all displacement components zero
  symmetric,  ///< normal displacement zero (plane of symmetry; axis-aligned planar groups only)
  antisymmetric,  ///< tangential displacements zero (axis-aligned planar groups only)
  displacement,   ///< u = value(X, t); absent components free
  traction        ///< nominal traction value(X, t) [Pa], force per reference area
};

struct BoundaryCondition {
  std::string group;  ///< gmsh physical group; of any dimension for displacements, of surfaces
                      ///< (3D) or curves (2D) for tractions
  BoundaryKind kind = BoundaryKind::fixed;
  VectorExpression value;
  bool value_from_exact = false;  ///< value = "exact": u, or P(F) N of the material law, of the
                                  ///< scene's exact solution
  SourcePosition where;           ///< of the [[boundary]] entry, for messages
};

enum class QuantityKind { point, average, reaction, maximum };

/// One quantity of interest; `name` gives its columns in history.csv and keys in summary.json.
struct Quantity {
  std::string name;
  QuantityKind kind = QuantityKind::point;
  Vec3 at = Vec3::Zero();  ///< point: reference position [m]
  std::string group;       ///< average, reaction: physical group; maximum: optional restriction
  std::string field;       ///< average, maximum: one of quantity_fields()
  bool interior_only =
      false;  ///< maximum: where = "interior", leaves out everything on the surface of the body
  SourcePosition where;
};

/// "displacement" [m], "velocity" [m/s], "displacement_error" [m] (needs an exact solution),
/// "von_mises" [Pa], "pressure" [Pa], "plastic_strain" (equivalent, eps_p, plastic materials
/// only), "kirchhoff_mises" (tau_eq = sqrt(3/2 dev tau : dev tau) of the Kirchhoff stress)
/// [Pa], "unbalanced_force" [N] (internal + external force at points without a prescribed
/// displacement; where everything is prescribed, at every point of the restriction).
const std::vector<std::string>& quantity_fields();

/// When a bond between two particles fails: by its strain, eps_ab >= sqrt(2 G_f/(E l_c)), Eqs.
/// (20) and (32) of the Continuum Bond Method paper; or by the work of the stress along it,
/// n.P N eps_ab/2 >= G_f/l_c with the mean stress of its ends, which is the same in uniaxial
/// tension and also sees what the bond does not stretch.
enum class FractureCriterion { strain, energy };

/// A cut that is there from the start: bonds that cross it are removed. In 3D it is drawn along Z.
struct PreCrack {
  Vec3 from = Vec3::Zero(), to = Vec3::Zero();  ///< [m]; cracks grow from `to` on
};

/// Brittle fracture of an elastic material.
struct Fracture {
  FractureCriterion criterion = FractureCriterion::strain;
  double energy_release_rate = 0;  ///< G_f [J/m^2], > 0
  double length = 0;               ///< l_c of (21), (32) [m]; 0: the run's spacing h
  std::vector<PreCrack> cracks;
  std::string arrival;   ///< group at which the crack's arrival is timed; may be empty
  SourcePosition where;  ///< of the table [fracture]
};

/// How the points of particle methods, and the meshes of the FEM, lie.
enum class Layout { lattice, unstructured };

struct Problem {
  std::string name;  ///< folder or file stem
  std::string title, source;
  std::filesystem::path file;  ///< the scene file
  std::string
      normalised_text;  ///< canonical text of everything read, overrides included (cache key)
  Dimension dimension = Dimension::three_d;
  std::filesystem::path geometry;  ///< the .geo file, absolute
  SourcePosition geometry_where;
  Layout layout = Layout::lattice;
  double reference_length = 1;  ///< L [m]; resolution N means h = L/N
  double thickness = 1;         ///< out-of-plane thickness of plane problems [m]; 1 in 3D
  bool is_static = false;
  int load_steps = 1;   ///< static: t runs from 0 to 1 in this many steps
  double end_time = 0;  ///< dynamic: [s]; static: 1
  std::map<std::string, double> parameters;
  Material material;
  std::vector<BoundaryCondition> boundaries;
  Vec3 gravity = Vec3::Zero();                           ///< [m/s^2]
  std::optional<VectorExpression> body_force;            ///< force per reference volume [N/m^3]
  std::optional<VectorExpression> initial_displacement;  ///< at t = 0 [m]
  std::optional<VectorExpression> initial_velocity;      ///< at t = 0 [m/s]
  std::optional<VectorExpression> exact_displacement;
  std::optional<VectorExpression> exact_velocity;
  std::optional<Fracture> fracture;
  std::vector<Quantity> quantities;
  int frames =
      20;  ///< field frames over the run, besides the initial one; 0: only the last state
  int history_rows = 200;  ///< rows of history.csv over the run; 0: only the ends

  int dim() const { return space_dim(dimension); }
  /// Exact displacement gradient at X, t. Requires exact_displacement.
  Mat3 exact_gradient(const Vec3& X, double t) const;
  /// Value of a displacement or traction condition at X, t; N is the outward unit normal (used
  /// by exact tractions only).
  Vec3 boundary_value(const BoundaryCondition& bc, const Vec3& X, double t,
                      const Vec3& N) const;
};

/// Throws InputError if the scene has fracture: for methods whose bonds cannot break.
void refuse_fracture(const Problem& problem, const std::string& method);

}  // namespace concord::scene
