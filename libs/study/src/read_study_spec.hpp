#pragma once

#include <optional>
#include <vector>

#include "kith/domains/domain.hpp"
#include "kith/files/column_names.hpp"
#include "kith/files/reader.hpp"
#include "kith/files/value.hpp"
#include "kith/study/group_options.hpp"
#include "kith/study/study_spec.hpp"
#include "kith/teaching/older_robot.hpp"

namespace kith {

/// The words that study files use.
inline const std::vector<std::string> kContrastFactorWords{columns::kStrategy, columns::kComposition};
inline constexpr const char* kStudySchema = "kith.study/1";

/// Reads every key of a study document into a specification; what is wrong goes
/// to the report, and its key keeps its default. `design.vary` is left alone.
/// @param domain  may be null, if it could not be read; then priors are not resolved.
/// @param models  what `learner.X.kind` may name; the first is the default.
[[nodiscard]] StudySpec read_study_spec(const TomlDocument& document, const Domain* domain, const StudyKinds& kinds,
                                        TomlReport& report);

/// Reads the tables of `[[contrast]]`; what is wrong goes to the report, and contrasts whose weights are wrong are left
/// out.
/// @param spec  with the rest of the study, whose strategies and compositions contrasts compare.
[[nodiscard]] std::vector<StudyContrast> read_contrasts(const TomlArray& list, const StudySpec& spec,
                                                        TomlReport& report);

/// Reads every key of `[group]`; what is wrong goes to the report, and its key keeps its default.
[[nodiscard]] GroupOptions read_group(TomlReader& group, TomlReport& report);

/// The table with every key written out; reading it gives the same options again.
[[nodiscard]] TomlTable discussion_table(const GroupDiscussion& discussion);
[[nodiscard]] TomlTable group_table(const GroupOptions& group);

// `knowing` of a learner type: { robot = "...", halfspaces = [...] }. What named a file has been replaced by it, or
// reported. Nothing if there is no such key, or after reporting what is wrong. @param domain  null: not known.
[[nodiscard]] std::optional<OlderRobot> read_knowing(TomlReader& learner, const Domain* domain, TomlReport& report);

// Reports what nobody can know, as no weights in the prior satisfy it.
void check_knowing(TomlReader& learner, const LearnerType& type, const Domain* domain, TomlReport& report);

// The teacher knows what people know, unless it is told otherwise or they know different things.
void presume_knowing(TomlReader& study, StudySpec& spec, const Domain* domain, TomlReport& report);

/// The half-spaces of a learner type's `prior`, a list of tables { feature = integer }.
/// Nothing if the domain is unknown (null), or after reporting what is wrong: an unknown feature, a normal of zeros, a
/// half-space that does not hold at the robot's weights, or no region in common.
/// @param is_of_older  the region of an older robot: it need not hold, and normals may be long.
[[nodiscard]] std::optional<std::vector<HalfSpace>> read_prior(const TomlArray& list, const TomlPlace& place,
                                                               const Domain* domain, TomlReport& report,
                                                               bool is_of_older = false);
/// `knowing` of a learner type as it is kept: { robot = "...", halfspaces = [...] }.
[[nodiscard]] TomlTable knowing_table(const OlderRobot& robot, const Domain& domain);

/// Reads the tables of `[learner]`; what is wrong goes to the report.
[[nodiscard]] std::vector<LearnerType> read_learner_types(TomlReader& study, const Domain* domain,
                                                          const StudyKinds& kinds, TomlReport& report);

template <typename Target, typename Value>
void set_if(Target& target, const std::optional<Value>& value) {
  if (value) target = static_cast<Target>(*value);
}

}  // namespace kith
