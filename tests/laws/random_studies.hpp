#pragma once

#include <string>
#include <vector>

#include "kith/core/stream.hpp"
#include "kith/study/study_file.hpp"

namespace kith::laws {

/// What the keys of [teacher], [stop], [pace] and [record] may be, found by asking: whatever a study can be written
/// with is set to what no key can be, and the error says what it can.
struct StudyKey {
  std::string name;                ///< "teacher.particles"
  std::vector<std::string> words;  ///< Of a word, or true and false.
  bool is_integer = false;         ///< Of a number, as are its limits.
  double min = 0.0, max = 0.0;
  bool min_is_open = false, max_is_open = false;
};
[[nodiscard]] const std::vector<StudyKey>& study_keys();

/// The text of a study of a few teams. About a third of all keys are set, to anything in their range, whole numbers to
/// at most a few dozen; the same of the parameters that learner models and strategies declare. It need not be valid:
/// keys can contradict each other.
/// @param domain  a built-in name, or a file.
[[nodiscard]] std::string random_study(const std::string& domain, RandomStream random);

}  // namespace kith::laws
