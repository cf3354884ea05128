#pragma once
// Expressions of a scene file: functions of X, Y, Z (reference position), t and the scene's
// parameters.

#include "scene/errors.hpp"
#include "scene/types.hpp"

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace concord::scene {

/// One scalar expression in SI units, e.g. "U*sin(pi/2*X)*cos(w*t)". Parsed once, by muParser;
/// `pi` is known. Evaluation is not thread-safe on one object; copies are independent.
class Expression {
 public:
  Expression();  ///< the constant 0
  /// Throws InputError at `where` for a syntax error or an unknown name (listing the known
  /// ones).
  Expression(const std::string& text, const std::map<std::string, double>& parameters,
             const SourcePosition& where = {}, const std::string& key = "expression");
  Expression(const Expression& other);
  Expression& operator=(const Expression& other);
  Expression(Expression&&) noexcept;
  Expression& operator=(Expression&&) noexcept;
  ~Expression();

  double operator()(const Vec3& X, double t) const;
  bool depends_on_time() const noexcept;
  bool is_zero() const noexcept;  ///< the literal constant 0: nothing to compute
  const std::string& text() const noexcept;

 private:
  struct Impl;
  std::unique_ptr<Impl> m_impl;
};

/// Three expressions; a component may be left out ("free") in a prescribed displacement.
struct VectorExpression {
  std::array<std::optional<Expression>, 3> component;

  /// Value at X, t; absent components give 0.
  Vec3 operator()(const Vec3& X, double t) const;
  bool depends_on_time() const;
  bool is_zero() const;
  /// Gradient with respect to X, G_ij = d u_i / d X_j, by fourth-order central differences with
  /// step `step` [m] (error about 1e-12 relative for smooth fields and step = 1e-3 of the
  /// length over which they vary).
  Mat3 gradient(const Vec3& X, double t, double step) const;
};

}  // namespace concord::scene
