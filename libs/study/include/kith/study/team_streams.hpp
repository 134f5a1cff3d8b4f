#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include "kith/core/stream.hpp"
#include "kith/learners/learner.hpp"
#include "kith/study/records.hpp"
#include "kith/study/study_spec.hpp"
#include "kith/teaching/cache.hpp"

namespace kith {

// Where the chance of a team comes from: one place, so that a simulated team and a live group of stand-ins with the
// same address are the same to the bit.

/// The root of all that is drawn for a team: seed / strategy, unless strategies share people / composition / replicate.
[[nodiscard]] RandomStream team_stream(const StudySpec& spec, const TeamAddress& address);
/// The same as people read it: "1/NNP/2".
[[nodiscard]] std::string readable_address(const StudySpec& spec, const TeamAddress& address);

/// The root of all that is drawn for one person. @param member  from 1.
[[nodiscard]] RandomStream person_stream(const RandomStream& team, std::size_t member);
/// What the teacher draws for the belief about that person.
[[nodiscard]] RandomStream belief_stream(const RandomStream& person);
/// What the teacher of the whole team draws besides.
[[nodiscard]] RandomStream teacher_stream(const RandomStream& team);
/// The same in the baseline, where every person has a teacher of their own.
[[nodiscard]] RandomStream lone_teacher_stream(const RandomStream& person);

/// The type of a person of whom a composition has this letter: that of the letter, or one drawn from its mixture.
/// @throws std::invalid_argument if there is no such type.
[[nodiscard]] const LearnerType& type_of_person(const StudySpec& spec, char letter, const RandomStream& person);
/// The numbers that describe a person of this type.
/// @throws kith::Error (kInfeasible) if no person meets the parameters of the type.
[[nodiscard]] std::vector<double> draw_traits(const LearnerType& type, const RandomStream& person);
/// The person with these numbers, before the first component.
/// @param cache  of the study's atlas; changes no result.
[[nodiscard]] std::unique_ptr<Learner> make_learner(const StudySpec& spec, const LearnerType& type,
                                                    const std::vector<double>& traits, const RandomStream& person,
                                                    TeachingCache& cache);

}  // namespace kith
