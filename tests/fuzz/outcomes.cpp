#include "outcomes.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>

namespace kith::fuzzing {
namespace {

// Of mistakes that keep a text from being looked at any further: TOML, tables, JSON, PRISM's lines, worlds.
constexpr std::array<std::string_view, 15> kSyntaxIds{"E0101", "E0102", "E0103", "E0104", "E0105",
                                                      "E0501", "E0502", "E0503", "E0504", "E0508",
                                                      "E0509", "E0512", "E0234", "E0236", "E0701"};
constexpr std::size_t kMostRemembered = 1'000'000;
constexpr std::size_t kMostKept = 256;

}  // namespace

Outcome outcome_of(const std::vector<Diagnostic>& diagnostics) {
  if (!has_errors(diagnostics)) return Outcome::kRead;
  const bool malformed = std::any_of(diagnostics.begin(), diagnostics.end(), [](const Diagnostic& d) {
    return std::find(kSyntaxIds.begin(), kSyntaxIds.end(), d.id) != kSyntaxIds.end();
  });
  return malformed ? Outcome::kMalformed : Outcome::kRefused;
}

Outcomes::~Outcomes() {
  constexpr std::array<const char*, 3> kNames{"malformed", "refused", "read"};
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    std::fprintf(stderr, "stat::%s_inputs: %zu\n", kNames.at(i), counts_.at(i));
  }
}

void Outcomes::add(std::string_view input, Outcome outcome) {
  const auto number = counts_[1] + counts_[2];
  ++counts_.at(static_cast<std::size_t>(outcome));
  if (outcome == Outcome::kMalformed) {
    if (malformed_.size() < kMostRemembered) malformed_.insert(std::hash<std::string_view>{}(input));
  } else if (well_formed_.size() < kMostKept) {
    well_formed_.emplace_back(input);
  } else {
    well_formed_[number % kMostKept] = input;
  }
}

bool Outcomes::was_malformed(std::string_view input) const {
  return malformed_.count(std::hash<std::string_view>{}(input)) > 0;
}

std::string Outcomes::well_formed(Dice& dice) const {
  return well_formed_.empty() ? std::string{} : dice.pick(well_formed_);
}

Outcomes& outcomes() {
  static Outcomes all;
  return all;
}

}  // namespace kith::fuzzing
