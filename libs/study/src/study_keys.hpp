#pragma once

#include <span>

#include "kith/core/option_key.hpp"
#include "kith/study/study_keys.hpp"
#include "kith/study/study_spec.hpp"

namespace kith {

template <>
inline constexpr std::array kWordsFor<Pairing>{WordFor{Pairing::kReplicate, "replicate"},
                                               WordFor{Pairing::kNone, "none"}};

// The keys that are fields of a StudySpec, in the order of written files; those of TeachingOptions come before them.
[[nodiscard]] std::span<const OptionKey<StudySpec>> more_teacher_keys();  // all but the beliefs
[[nodiscard]] std::span<const OptionKey<StudySpec>> pace_keys();
[[nodiscard]] std::span<const OptionKey<StudySpec>> record_keys();

}  // namespace kith
