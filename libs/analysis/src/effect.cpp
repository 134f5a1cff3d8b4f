#include "kith/analysis/effect.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>

#include "kith/core/text.hpp"
#include "kith/files/column_names.hpp"

namespace kith {
namespace {

constexpr const char* kGrammar =
    "write for instance \"periods: strategy\", \"knowledge: strategy x composition\", \"periods: strategy eta2 = "
    "0.02\" "
    "or \"knowledge: joint - common = 0.05\"";

EffectReading refuse(std::string problem, std::string hint = kGrammar) {
  return {{}, std::move(problem), std::move(hint)};
}

// The words, with '=' a word of its own.
std::vector<std::string> words_of(std::string_view text) {
  std::string spaced;
  for (const char c : text) spaced += c == '=' ? std::string{" = "} : std::string{c};
  std::istringstream stream{spaced};
  std::vector<std::string> words;
  for (std::string word; stream >> word;) words.push_back(word);
  return words;
}

std::optional<double> number(const std::string& text) {
  double value = 0.0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  if (result.ec != std::errc{} || result.ptr != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

bool is_product(const std::string& word) { return word == "x" || word == "*" || word == ":"; }

// The number of group strategies and of compositions decides what can be tested.
std::optional<std::string> untestable(const Effect& effect, const StudySpec& spec) {
  const auto groups = static_cast<std::size_t>(std::count_if(
      spec.strategies.begin(), spec.strategies.end(), [](const StrategyChoice& one) { return !one.is_baseline(); }));
  const bool needs_strategies = effect.kind != Effect::Kind::kContrast && effect.kind != Effect::Kind::kComposition;
  if (needs_strategies && groups < 2) return "the study has fewer than two group strategies";
  if (effect.kind == Effect::Kind::kComposition && groups < 1) return "the study has no group strategy";
  const bool needs_compositions =
      effect.kind == Effect::Kind::kComposition || effect.kind == Effect::Kind::kInteraction;
  if (needs_compositions && spec.compositions.size() < 2) return "the study has fewer than two compositions";
  return std::nullopt;
}

// What stands before the size.
std::optional<std::string> read_term(const std::vector<std::string>& words, const StudySpec& spec, Effect& effect) {
  const auto n = words.size();
  if (n == 1 && words[0] == columns::kStrategy) {
    effect.kind = Effect::Kind::kStrategy;
  } else if (n == 1 && words[0] == columns::kComposition) {
    effect.kind = Effect::Kind::kComposition;
  } else if ((n == 3 && words[0] == columns::kStrategy && is_product(words[1]) && words[2] == columns::kComposition) ||
             (n == 1 && (words[0] == "strategy:composition" || words[0] == "strategy*composition"))) {
    effect.kind = Effect::Kind::kInteraction;
  } else if (n == 3 && words[0] == columns::kStrategy && words[1] == "in") {
    effect.kind = Effect::Kind::kStrategyWithin;
    effect.composition = words[2];
    const auto& all = spec.compositions;
    if (std::find(all.begin(), all.end(), words[2]) == all.end())
      return "the study has no composition '" + words[2] + "'";
  } else if (n == 3 && words[1] == "-") {
    effect.kind = Effect::Kind::kContrast;
    for (const auto* word : {&words[0], &words[2]}) {
      const auto selection = parse_selection(*word, spec);
      if (!selection) return "the study has no teams '" + *word + "'";
      (word == &words[0] ? effect.first : effect.second) = *selection;
    }
    for (const auto& strategy : spec.strategies) {
      for (const auto& composition : spec.compositions) {
        const TeamAddress team{.strategy = strategy.name, .composition = composition};
        if (effect.first.contains(team) && effect.second.contains(team))
          return "an effect compares different teams, but " + strategy.name +
                 " is on both sides; list the others, as in common+individual-low - joint";
      }
    }
  } else {
    return "the effect is not understood";
  }
  return untestable(effect, spec);
}

}  // namespace

std::string to_string(const Effect& effect) {
  std::string text = std::string{effect.outcome->column} + ": ";
  switch (effect.kind) {
    case Effect::Kind::kStrategy:
      text += columns::kStrategy;
      break;
    case Effect::Kind::kComposition:
      text += columns::kComposition;
      break;
    case Effect::Kind::kInteraction:
      text += "strategy x composition";
      break;
    case Effect::Kind::kStrategyWithin:
      text += "strategy in " + effect.composition;
      break;
    case Effect::Kind::kContrast:
      text += to_string(effect.first) + " - " + to_string(effect.second);
      break;
  }
  if (!effect.imposed) return text;
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, *effect.imposed).ptr;
  return text + (effect.kind == Effect::Kind::kContrast ? " = " : " eta2 = ") + std::string(buffer, end);
}

EffectReading parse_effect(std::string_view text, const StudySpec& spec) {
  const auto colon = text.find(':');
  if (colon == std::string_view::npos) return refuse("'" + std::string{text} + "' names no quantity");
  const auto quantity_words = words_of(text.substr(0, colon));
  const auto* const quantity = quantity_words.size() == 1 ? find_outcome(quantity_words.front()) : nullptr;
  if (quantity == nullptr) {
    return refuse("there is no quantity '" + std::string{text.substr(0, colon)} + "'",
                  "known: " + joined(outcomes(), ", ", &StudyOutcome::column));
  }
  Effect effect;
  effect.outcome = quantity;
  auto words = words_of(text.substr(colon + 1));
  const bool sized = words.size() >= 2 && words[words.size() - 2] == "=";
  if (sized) {
    effect.imposed = number(words.back());
    if (!effect.imposed) return refuse("'" + words.back() + "' is no number");
    words.resize(words.size() - 2);
  }
  const bool eta = sized && !words.empty() && words.back() == "eta2";
  if (eta) words.pop_back();
  if (auto problem = read_term(words, spec, effect)) return refuse(*std::move(problem));
  const bool contrast = effect.kind == Effect::Kind::kContrast;
  if (sized && eta == contrast) {
    return refuse(contrast ? "a difference has a size in its own unit" : "the size of a term is its eta2");
  }
  if (eta && !(*effect.imposed > 0.0 && *effect.imposed < 1.0)) return refuse("eta2 must lie between 0 and 1");
  if (sized && contrast && *effect.imposed == 0.0) return refuse("an imposed difference must not be 0");
  return {effect, {}, {}};
}

std::vector<Effect> effects_of(const StudyContrast& contrast, const StudySpec& spec) {
  std::string sides[2];
  double weights[2] = {0.0, 0.0};
  const bool of_compositions = contrast.factor == columns::kComposition;
  for (const auto& [level, weight] : contrast.weights) {
    if (weight == 0.0) continue;
    const int side = weight < 0.0 ? 1 : 0;
    if (!sides[side].empty() && (of_compositions || weight != weights[side])) return {};
    weights[side] = weight;
    sides[side] += (sides[side].empty() ? of_compositions ? "group/" : "" : "+") + level;
  }
  std::vector<Effect> effects;
  for (const auto* outcome : analysed_outcomes(spec.exam != ExamLevel::kNone, false)) {
    if (!contrast.response.empty() && contrast.response != outcome->column) continue;
    const auto reading = parse_effect(std::string{outcome->column} + ": " + sides[0] + " - " + sides[1], spec);
    if (reading.effect) effects.push_back(*reading.effect);
  }
  return effects;
}

}  // namespace kith
