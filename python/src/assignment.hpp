#pragma once

#include <string>
#include <vector>

#include "binding.hpp"
#include "domain.hpp"
#include "kith/study/study_file.hpp"

namespace kith::python {

/// A study by name, path or, if `text` is not empty, its own text.
struct StudySource {
  std::string name;
  std::string text;
  std::vector<std::string> overrides;  ///< KEY=VALUE
};
/// @throws kith::Error with diagnostics. @pre the lock is held: warnings are Python's.
[[nodiscard]] StudyReading read_study(const StudySource& source, const StudyKinds& kinds);

/// One team of a domain, as `kith teach` has it: learner types and the teacher's settings are those of a study.
struct Assignment {
  StudySpec spec;
  TeamAddress address;
};
/// @param group  letters of learner types; empty: `members` people of the study's first type.
/// @param strategy  of kith or one that was registered.
[[nodiscard]] Assignment assignment_of(const Domain& domain, std::string group, std::size_t members,
                                       const std::string& strategy, std::uint64_t seed, const StudySource& study);

}  // namespace kith::python
