#include "outcomes.hpp"

#include <algorithm>
#include <cstdio>
#include <functional>

namespace kith::fuzzing {
namespace {

// Of mistakes that keep a text from being looked at any further: TOML, tables, worlds.
constexpr std::array<std::string_view, 12> kSyntaxIds{"E0101", "E0102", "E0103", "E0104", "E0105", "E0501",
                                                      "E0502", "E0503", "E0504", "E0508", "E0509", "E0512"};
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

Outcomes::Outcomes() : memory_(kMostRemembered) {
  for (auto& kept : kept_) kept.inputs.resize(kMostKept);
  for (auto& kept : kept_)
    for (auto& input : kept.inputs) input.reserve(kLongestKept);
}

Outcomes::~Outcomes() {
  constexpr std::array<const char*, 3> kNames{"malformed", "refused", "read"};
  for (std::size_t i = 0; i < counts_.size(); ++i) {
    std::fprintf(stderr, "stat::%s_inputs: %zu\n", kNames.at(i), counts_.at(i));
  }
}

void Outcomes::add(std::string_view input, Outcome outcome) {
  const auto i = static_cast<std::size_t>(outcome);
  ++counts_.at(i);
  const auto hash = std::hash<std::string_view>{}(input);
  memory_[hash % kMostRemembered] = {hash, outcome};
  if (outcome == Outcome::kMalformed || input.size() > kLongestKept) return;
  auto& kept = kept_.at(i);
  kept.inputs[kept.seen++ % kMostKept] = input;
}

std::optional<Outcome> Outcomes::of(std::string_view input) const {
  const auto hash = std::hash<std::string_view>{}(input);
  const auto& memory = memory_[hash % kMostRemembered];
  return memory.hash == hash ? std::optional{memory.outcome} : std::nullopt;
}

std::string Outcomes::one_that(Outcome came, Dice& dice) const {
  const auto& read = kept_.at(static_cast<std::size_t>(Outcome::kRead));
  const auto& refused = kept_.at(static_cast<std::size_t>(Outcome::kRefused));
  const bool take_refused = came != Outcome::kRead && refused.seen > 0 && (read.seen == 0 || dice.one_in(2));
  const auto& kept = take_refused ? refused : read;
  return kept.seen == 0 ? std::string{} : kept.inputs[dice.below(std::min(kept.seen, kMostKept))];
}

Outcomes& outcomes() {
  static Outcomes all;
  return all;
}

}  // namespace kith::fuzzing
