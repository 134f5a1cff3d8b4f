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
constexpr std::size_t kMostRemembered = std::size_t{1} << 18;
constexpr std::size_t kMostKept = 128;
constexpr std::size_t kLongestKept = 2048;

}  // namespace

Outcome outcome_of(const std::vector<Diagnostic>& diagnostics) {
  if (!has_errors(diagnostics)) return Outcome::kRead;
  const bool malformed = std::any_of(diagnostics.begin(), diagnostics.end(), [](const Diagnostic& d) {
    return std::find(kSyntaxIds.begin(), kSyntaxIds.end(), d.id) != kSyntaxIds.end();
  });
  return malformed ? Outcome::kMalformed : Outcome::kRefused;
}

Outcomes::Outcomes() : malformed_(kMostRemembered), well_formed_(kMostKept) {
  for (auto& input : well_formed_) input.reserve(kLongestKept);
}

Outcomes::~Outcomes() {
  constexpr std::array<const char*, 3> kNames{"malformed", "refused", "read"};
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    std::fprintf(stderr, "stat::%s_inputs: %zu\n", kNames.at(i), counts_.at(i));
  }
}

void Outcomes::add(std::string_view input, Outcome outcome) {
  ++counts_.at(static_cast<std::size_t>(outcome));
  if (outcome == Outcome::kMalformed) {
    const auto hash = std::hash<std::string_view>{}(input);
    malformed_[hash % kMostRemembered] = hash;
  } else if (input.size() <= kLongestKept) {
    well_formed_[num_well_formed_++ % kMostKept] = input;
  }
}

bool Outcomes::was_malformed(std::string_view input) const {
  const auto hash = std::hash<std::string_view>{}(input);
  return malformed_[hash % kMostRemembered] == hash;
}

std::string Outcomes::well_formed(Dice& dice) const {
  const auto kept = std::min(num_well_formed_, kMostKept);
  return kept == 0 ? std::string{} : well_formed_[dice.below(kept)];
}

Outcomes& outcomes() {
  static Outcomes all;
  return all;
}

}  // namespace kith::fuzzing
