#pragma once

#include <vector>

#include "kith/teaching/session.hpp"

namespace kith::testing {

/// Answers to the tests of the session's lesson: everywhere the robot's own path.
inline std::vector<Answer> robots_answers(const Session& session) {
  std::vector<Answer> answers;
  for (const auto& test : session.lesson().tests) answers.emplace_back(session.atlas().feature_counts(test.start));
  return answers;
}

}  // namespace kith::testing
