#include "kith/explain/target.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <map>
#include <tuple>

#include "kith/core/error.hpp"
#include "kith/explain/words.hpp"
#include "question_parser.hpp"

namespace kith {
namespace {

const ConstraintSet& set_for(const Atlas& atlas, StartIndex start, Purpose purpose) {
  return purpose == Purpose::kTeach ? atlas.one_step(start) : atlas.tested_constraints(start);
}

// The minimal set of what the constraint leaves of the prior; empty if it contradicts it.
std::vector<HalfSpace> target_facets(const Cone& prior, const HalfSpace& constraint) {
  const auto region = prior.clipped(constraint);
  return region ? region->minimal_set() : std::vector<HalfSpace>{};
}

// The half-spaces of a region that are not among those of the prior.
std::vector<HalfSpace> beyond_prior(const Atlas& atlas, const Cone& region) {
  std::vector<HalfSpace> left;
  for (const auto& facet : region.minimal_set()) {
    if (!atlas.prior_cone().implies(facet)) left.push_back(facet);
  }
  return left;
}

// What sets leave of the prior: few of many sets differ.
class Remainders {
 public:
  explicit Remainders(const Atlas& atlas) : atlas_{atlas} {}

  // Nothing if the set contradicts the prior, which sets of the robot's never do.
  const std::vector<HalfSpace>& facets(const ConstraintSet& set) {
    std::vector<std::size_t> key;
    for (const auto c : set.members()) key.push_back(c.value());
    const auto [place, is_new] = known_.try_emplace(std::move(key));
    if (is_new) {
      auto region = atlas_.prior_cone();
      if (region.clip(atlas_.constraints().half_spaces(set))) place->second = region.minimal_set();
    }
    return place->second;
  }

 private:
  const Atlas& atlas_;
  std::map<std::vector<std::size_t>, std::vector<HalfSpace>> known_;
};

std::string plain(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (std::isspace(static_cast<unsigned char>(c)) != 0) {
      if (!result.empty() && result.back() != ' ') result += ' ';
    } else {
      result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  while (!result.empty() && (result.back() == ' ' || result.back() == '.')) result.pop_back();
  return result;
}

// The numbers of "(-1, 0, 2)"; nothing if there is anything else.
std::optional<std::vector<std::int64_t>> numbers_in(const std::string& text) {
  std::vector<std::int64_t> numbers;
  std::size_t i = 0;
  while (i < text.size()) {
    const char c = text[i];
    if (std::isspace(static_cast<unsigned char>(c)) != 0 || c == ',' || c == '(' || c == ')') {
      ++i;
      continue;
    }
    std::size_t end = i + (c == '-' || c == '+' ? 1 : 0);
    const auto digits = end;
    while (end < text.size() && std::isdigit(static_cast<unsigned char>(text[end])) != 0) ++end;
    constexpr std::size_t kMostDigits = 9;
    if (end == digits || end - digits > kMostDigits) return std::nullopt;
    numbers.push_back(std::stoll(text.substr(i, end - i)));
    i = end;
  }
  if (numbers.empty()) return std::nullopt;
  return numbers;
}

[[noreturn]] void fail(const std::string& id, const std::string& message, const Advice& advice, bool infeasible) {
  Diagnostic diagnostic;
  diagnostic.id = id;
  diagnostic.message = message;
  diagnostic.hint = advice.hint;
  diagnostic.remedy = advice.remedy;
  diagnostic.infeasible = infeasible;
  throw Error{infeasible ? ErrorKind::kInfeasible : ErrorKind::kInvalidInput, message, {diagnostic}};
}

// All sentences that can be said of this domain.
std::map<std::string, HalfSpace> sentences(const Atlas& atlas) {
  std::map<std::string, HalfSpace> known;
  const auto& table = atlas.constraints();
  for (ConstraintIndex c{0}; c.value() < table.size(); ++c) {
    const auto sentence = in_words(atlas.domain(), table[c]);
    if (!sentence.empty()) known.emplace(plain(sentence), table[c]);
  }
  return known;
}

// A sentence, or a comparison in other words. Of a sentence with a condition a constraint from which it follows.
std::optional<HalfSpace> said_in_words(const Atlas& atlas, const std::string& text) {
  detail::Question question;
  try {
    question = detail::parse_question(atlas.domain(), text);
  } catch (const Error&) {
    return std::nullopt;
  }
  if (!question.said || !question.condition) return question.said;
  const auto follows = [&](const HalfSpace& constraint) {
    auto region = atlas.prior_cone();
    return region.clip(std::array{constraint, *question.condition}) && region.implies(*question.said);
  };
  for (const auto& constraint : atlas.policy_bec_half_spaces()) {
    if (follows(constraint)) return constraint;
  }
  for (ConstraintIndex c{0}; c.value() < atlas.constraints().size(); ++c) {
    if (follows(atlas.constraints()[c])) return atlas.constraints()[c];
  }
  return question.said;
}

HalfSpace understood(const Atlas& atlas, const std::string& text) {
  const auto d = atlas.domain().num_features();
  if (const auto numbers = numbers_in(text)) {
    const bool is_zero = std::all_of(numbers->begin(), numbers->end(), [](auto n) { return n == 0; });
    if (numbers->size() != d || is_zero) {
      fail("E1109", "a constraint of this domain has " + std::to_string(d) + " numbers, not all of them 0",
           "one per feature: " + listed(atlas.domain().feature_names()), false);
    }
    IntegerVector normal(d);
    for (std::size_t k = 0; k < d; ++k) normal[k] = (*numbers)[k];
    return HalfSpace{normal};
  }
  const auto known = sentences(atlas);
  const auto found = known.find(plain(text));
  if (found != known.end()) return found->second;
  if (const auto said = said_in_words(atlas, text)) return *said;
  std::vector<std::string> all;
  all.reserve(known.size());
  for (const auto& [sentence, half_space] : known) all.push_back(sentence);
  const auto nearest = nearest_word(plain(text), all);
  fail("E1109", "'" + text + "' is not a constraint on this robot's reward",
       nearest.empty() ? Advice{"write its normal, such as (-1,0,2)", Remedy::kListConstraints}
                       : Advice{"did you mean '" + nearest + "'?"},
       false);
}

}  // namespace

bool leaves_out_ties(const Atlas& atlas) {
  const auto& domain = atlas.domain();
  for (StartIndex start{0}; start.value() < atlas.num_states(); ++start) {
    if (!atlas.is_candidate(start) || !atlas.has_tie(start)) continue;
    const auto [world, s] = atlas.id(start);
    for (std::size_t c = 0; c < domain.mdp(world).choices(s).size(); ++c) {
      const auto loss = atlas.feature_counts(start) - atlas.deviation_counts(start, c);
      if (loss.is_zero() || sign_of_dot(domain.weights().integer, loss) != 0) continue;
      if (!atlas.constraints().find(HalfSpace{loss})) return true;
    }
  }
  return false;
}

std::optional<StartIndex> simplest_isolating(const Atlas& atlas, const HalfSpace& constraint, Purpose purpose) {
  const auto target = target_facets(atlas.prior_cone(), constraint);
  Remainders regions{atlas};
  std::optional<std::tuple<int, std::size_t, StartIndex>> best;
  for (StartIndex start{0}; start.value() < atlas.num_states(); ++start) {
    if (!atlas.is_candidate(start)) continue;
    if (regions.facets(set_for(atlas, start, purpose)) != target) continue;
    const int complexity = atlas.complexity(start);
    const std::tuple candidate{complexity, atlas.trajectory(start).actions.size(), start};
    if (!best || candidate < *best) best = candidate;
  }
  if (!best) return std::nullopt;
  return std::get<StartIndex>(*best);
}

NotIsolated why_not_isolated(const Atlas& atlas, const HalfSpace& constraint, Purpose purpose) {
  Remainders regions{atlas};
  NotIsolated why;
  for (StartIndex start{0}; start.value() < atlas.num_states(); ++start) {
    if (!atlas.is_candidate(start)) continue;
    const auto& facets = regions.facets(set_for(atlas, start, purpose));
    auto region = atlas.prior_cone();
    if (facets.empty() || !region.clip(facets) || !region.implies(constraint)) continue;
    ++why.conveying;
    std::vector<HalfSpace> besides;
    for (const auto& facet : beyond_prior(atlas, region)) {
      if (facet != constraint) besides.push_back(facet);
    }
    if (why.nearest && why.besides.size() <= besides.size()) continue;
    why.nearest = start;
    why.besides = std::move(besides);
  }
  return why;
}

std::vector<Isolated> isolated_constraints(const Atlas& atlas) {
  std::map<HalfSpace, Isolated> found;
  const auto at = [&](const HalfSpace& constraint) -> Isolated& {
    return found.try_emplace(constraint, Isolated{constraint, 0, 0}).first->second;
  };
  for (const auto& constraint : atlas.policy_bec_half_spaces()) {
    if (!atlas.prior_cone().implies(constraint)) static_cast<void>(at(constraint));
  }
  Remainders regions{atlas};
  std::map<std::vector<HalfSpace>, std::vector<HalfSpace>> beyond;
  const auto only_one = [&](const ConstraintSet& set) -> std::optional<HalfSpace> {
    const auto& facets = regions.facets(set);
    const auto [place, is_new] = beyond.try_emplace(facets);
    if (is_new && !facets.empty()) place->second = beyond_prior(atlas, Cone::intersection(facets).value());
    if (place->second.size() != 1) return std::nullopt;
    return place->second.front();
  };
  for (StartIndex start{0}; start.value() < atlas.num_states(); ++start) {
    if (!atlas.is_candidate(start)) continue;
    if (const auto taught = only_one(atlas.one_step(start))) ++at(*taught).teaching;
    if (const auto tested = only_one(atlas.tested_constraints(start))) ++at(*tested).testing;
  }
  std::vector<Isolated> all;
  all.reserve(found.size());
  for (const auto& [constraint, isolated] : found) all.push_back(isolated);
  return all;
}

HalfSpace parse_constraint(const Atlas& atlas, const std::string& text) {
  const auto constraint = understood(atlas, text);
  const auto& domain = atlas.domain();
  if (sign_of_dot(constraint.normal(), domain.weights().integer) < 0) {
    fail("E1110", "this robot's reward contradicts " + normal_text(domain, constraint),
         "the opposite holds: " + described(domain, constraint.opposite()), true);
  }
  if (atlas.prior_cone().implies(constraint)) {
    fail("E1110", described(domain, constraint) + " is known to everybody beforehand", "see [prior] of the domain file",
         true);
  }
  return constraint;
}

}  // namespace kith
