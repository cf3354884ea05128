#include "scene/expression.hpp"

#include "scene/suggest.hpp"

#include <cmath>
#include <muParser.h>

namespace concord::scene {
namespace {

constexpr std::array<const char*, 4> variables{"X", "Y", "Z", "t"};

/// muParser knows assignment; a scene's expressions are values, so a single '=' is refused.
bool assigns(const std::string& text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] != '=') continue;
    const bool joined = i > 0 && std::string("=<>!").find(text[i - 1]) != std::string::npos;
    const bool doubled = i + 1 < text.size() && text[i + 1] == '=';
    if (!joined && !doubled) return true;
  }
  return false;
}

std::string known_names(const std::map<std::string, double>& parameters) {
  std::string names = "an expression of X, Y, Z, t, pi";
  for (const auto& [name, value] : parameters) names += ", " + name;
  return names + " with + - * / ^, sin, cos, tan, exp, log, sqrt, abs, min, max, a ? b : c";
}

}  // namespace

struct Expression::Impl {
  std::string text = "0";
  std::map<std::string, double> parameters;
  std::array<double, 4> value{};  // X, Y, Z, t; the parser holds their addresses
  mu::Parser parser;
  bool constant = true;
  bool timed = false;
  double constant_value = 0;

  Impl() = default;
  Impl(const std::string& expression, const std::map<std::string, double>& given)
      : text(expression), parameters(given) {
    parser.DefineConst("pi", M_PI);
    for (const auto& [name, number] : parameters) parser.DefineConst(name, number);
    for (std::size_t i = 0; i < variables.size(); ++i)
      parser.DefineVar(variables[i], &value[i]);
    parser.SetExpr(text);
    const double first = parser.Eval();
    if (parser.GetNumResults() != 1) throw mu::ParserError("more than one value");
    const auto& used = parser.GetUsedVar();
    constant = used.empty();
    timed = used.contains("t");
    if (constant) constant_value = first;
  }
};

Expression::Expression() : m_impl(std::make_unique<Impl>()) {}

Expression::Expression(const std::string& text, const std::map<std::string, double>& parameters,
                       const SourcePosition& where, const std::string& key) {
  if (text.find_first_not_of(" \t") == std::string::npos)
    throw InputError(where, key, "an empty expression", known_names(parameters));
  if (assigns(text))
    throw InputError(where, key, in_quotes(text) + ", an assignment", known_names(parameters));
  try {
    m_impl = std::make_unique<Impl>(text, parameters);
  } catch (const mu::ParserError& error) {
    throw InputError(where, key, in_quotes(text) + " (" + error.GetMsg() + ")",
                     known_names(parameters));
  }
  if (m_impl->constant && !std::isfinite(m_impl->constant_value))
    throw InputError(where, key, in_quotes(text) + ", which is not finite",
                     known_names(parameters));
}

Expression::Expression(const Expression& other)
    : m_impl(other.m_impl ? std::make_unique<Impl>(other.m_impl->text, other.m_impl->parameters)
                          : std::make_unique<Impl>()) {}

Expression& Expression::operator=(const Expression& other) {
  if (this != &other) *this = Expression(other);
  return *this;
}

Expression::Expression(Expression&&) noexcept = default;
Expression& Expression::operator=(Expression&&) noexcept = default;
Expression::~Expression() = default;

double Expression::operator()(const Vec3& X, double t) const {
  if (m_impl->constant) return m_impl->constant_value;
  m_impl->value = {X[0], X[1], X[2], t};
  return m_impl->parser.Eval();
}

bool Expression::depends_on_time() const noexcept { return m_impl->timed; }
bool Expression::is_zero() const noexcept {
  return m_impl->constant && m_impl->constant_value == 0;
}
const std::string& Expression::text() const noexcept { return m_impl->text; }

Vec3 VectorExpression::operator()(const Vec3& X, double t) const {
  Vec3 value = Vec3::Zero();
  for (int i = 0; i < 3; ++i)
    if (component[i]) value[i] = (*component[i])(X, t);
  return value;
}

bool VectorExpression::depends_on_time() const {
  for (const auto& c : component)
    if (c && c->depends_on_time()) return true;
  return false;
}

bool VectorExpression::is_zero() const {
  for (const auto& c : component)
    if (c && !c->is_zero()) return false;
  return true;
}

Mat3 VectorExpression::gradient(const Vec3& X, double t, double step) const {
  // f' = (8 (f_1 - f_-1) - (f_2 - f_-2)) / (12 h) + h^4 f^(5)/30. A power of two as step makes
  // X + step exact more often, and with it the difference quotient of linear fields.
  const double h = std::exp2(std::round(std::log2(step)));
  Mat3 G;
  for (int j = 0; j < 3; ++j) {
    const Vec3 e = Vec3::Unit(j) * h;
    const Vec3 near = (*this)(X + e, t) - (*this)(X - e, t);
    const Vec3 far = (*this)(X + 2 * e, t) - (*this)(X - 2 * e, t);
    G.col(j) = (8 * near - far) / (12 * h);
  }
  return G;
}

}  // namespace concord::scene
