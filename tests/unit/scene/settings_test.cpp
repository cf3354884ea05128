#include "scene/method.hpp"

#include <gtest/gtest.h>

using namespace concord;
using namespace concord::scene;

namespace {

std::vector<ParameterInfo> table() {
  ParameterInfo xi{"xi_n", "1", "1", ">= 0", "normal stiffness", 0, 1e300, {}};
  ParameterInfo kernel{"kernel", "1",    "cubic-spline", "",
                       "kernel", -1e300, 1e300,          {"cubic-spline", "wendland-c2"}};
  return {xi, kernel};
}

class Nothing : public Method {
 public:
  explicit Nothing(std::string name) { m_info.name = std::move(name); }
  const MethodInfo& info() const override { return m_info; }
  void run(const Problem&, const RunRequest&, Result&) const override {}

 private:
  MethodInfo m_info;
};

}  // namespace

TEST(Settings, DefaultsAndWhatWasSet) {
  const Settings s("m", table(), {{"xi_n", "0.1"}});
  EXPECT_EQ(s.number("xi_n"), 0.1);
  EXPECT_EQ(s.word("kernel"), "cubic-spline");
  EXPECT_EQ(s.variant(), "xi_n=0.1");
  EXPECT_EQ(Settings("m", table(), {{"xi_n", "1.0"}}).variant(), "");
  EXPECT_THROW(s.number("kernel"), InputError);
  EXPECT_THROW(s.number("undeclared"), std::logic_error);
}

TEST(Settings, RefusesUnknownKeysAndValuesOutOfRange) {
  using Given = std::map<std::string, std::string>;
  EXPECT_THROW(Settings("m", table(), Given{{"xi_m", "1"}}), InputError);
  EXPECT_THROW(Settings("m", table(), Given{{"xi_n", "-1"}}), InputError);
  EXPECT_THROW(Settings("m", table(), Given{{"xi_n", "one"}}), InputError);
  EXPECT_THROW(Settings("m", table(), Given{{"xi_n", "1x"}}), InputError);
  EXPECT_THROW(Settings("m", table(), Given{{"xi_n", "nan"}}), InputError);
  EXPECT_THROW(Settings("m", table(), Given{{"kernel", "spline"}}), InputError);
  try {
    const Settings s("m", table(), Given{{"xi_m", "1"}});
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(e.allowed().find("did you mean xi_n?"), std::string::npos) << e.what();
  }
}

TEST(MethodRegistry, FindsSortsAndRefuses) {
  MethodRegistry registry;
  registry.add(std::make_unique<Nothing>("b"));
  registry.add(std::make_unique<Nothing>("a"));
  EXPECT_EQ(registry.find("a").info().name, "a");
  EXPECT_EQ(registry.all().front()->info().name, "a");
  EXPECT_THROW(registry.find("c"), InputError);
  EXPECT_THROW(registry.add(std::make_unique<Nothing>("a")), std::logic_error);
}
