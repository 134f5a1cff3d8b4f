#pragma once

#include <array>

#include "kith/analysis/finding.hpp"
#include "kith/core/option_key.hpp"

namespace kith {

template <>
inline constexpr std::array kWordsFor<ResultKind>{
    WordFor{ResultKind::kText, "text"}, WordFor{ResultKind::kCount, "count"}, WordFor{ResultKind::kNumber, "number"},
    WordFor{ResultKind::kFraction, "fraction"}, WordFor{ResultKind::kP, "p"}};

}  // namespace kith
