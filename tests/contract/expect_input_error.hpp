#pragma once
// Runs what must fail and compares the error's place, key and words.

#include "tests/unit/scene/scratch_scene.hpp"

#include <gtest/gtest.h>

namespace concord::test {

/// `mark` is text of the scene file where the error's position must be (its first occurrence);
/// empty: the position is not in the file.
struct Expected {
  std::string mark, key, found, allowed;
};

inline void expect_position(const std::string& text, const std::string& mark,
                            const SourcePosition& where, const std::string& message) {
  const std::size_t at = text.find(mark);
  ASSERT_NE(at, std::string::npos) << "the test's own mark is not in the scene: " << mark;
  const auto line = 1 + std::count(text.begin(), text.begin() + static_cast<long>(at), '\n');
  const std::size_t start = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
  const std::size_t column = start == std::string::npos ? at + 1 : at - start;
  EXPECT_EQ(where.line, line) << message;
  EXPECT_EQ(static_cast<std::size_t>(where.column), column) << message;
}

template <class Call>
void expect_input_error(const std::string& text, const Expected& expected, Call&& call) {
  try {
    call();
    ADD_FAILURE() << "nothing was thrown for\n" << text;
  } catch (const InputError& error) {
    const std::string message = error.what();
    if (!expected.mark.empty()) {
      expect_position(text, expected.mark, error.where(), message);
      EXPECT_NE(error.where().file.find("scene.toml"), std::string::npos) << message;
    }
    EXPECT_EQ(error.key(), expected.key) << message;
    EXPECT_NE(error.found().find(expected.found), std::string::npos) << message;
    EXPECT_NE(error.allowed().find(expected.allowed), std::string::npos) << message;
  }
}

/// Reads the scene and expects the error.
inline void expect_scene_error(const std::string& text, const Expected& expected,
                               const std::vector<scene::Override>& overrides = {}) {
  const ScratchScene scratch(text);
  expect_input_error(text, expected, [&] { (void)scratch.read(overrides); });
}

}  // namespace concord::test
