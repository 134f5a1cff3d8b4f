// Is something true of what the robot likes and dislikes?
#include "answerer.hpp"

#include "kith/explain/words.hpp"

namespace kith::detail {

namespace {

// The weights under which all of them hold.
Cone region_of(const std::vector<HalfSpace>& some, const std::optional<HalfSpace>& more, std::size_t d) {
  Cone region{d};
  static_cast<void>(region.clip(some));
  if (more) static_cast<void>(region.clip(*more));
  return region;
}

}  // namespace

std::string Answerer::statement_text(const HalfSpace& said) const {
  const auto sentence = in_words(domain_, said);
  return (question_.condition ? "if " + in_words(domain_, *question_.condition) + ", " : std::string{}) +
         (sentence.empty() ? normal_text(domain_, said) + " . w >= 0" : sentence);
}

void Answerer::whether() {
  const auto& said = *question_.said;
  const auto d = domain_.num_features();
  reply_.question = "Is it true that " + statement_text(said) + "?";
  std::vector<HalfSpace> known{domain_.prior().begin(), domain_.prior().end()};
  auto shown = atlas_.policy_bec_half_spaces();
  shown.insert(shown.end(), known.begin(), known.end());
  const auto region = region_of(shown, question_.condition, d);
  if (region_of(known, question_.condition, d).implies(said)) {
    reply_.text = "Yes, and everybody knows it beforehand.";
    return;
  }
  if (region.implies(said)) {
    reply_.text = "Yes: what it does shows that " + statement_text(said) + ".";
    return show_why_true(said, known);
  }
  const auto opposite = said.opposite();
  if (region.implies(opposite)) {
    reply_.text = "No: what it does shows that " + statement_text(opposite) + ".";
    return show_why_true(opposite, known);
  }
  reply_.text = "What it does does not tell: it would do the same if that were so, and if it were not.";
}

void Answerer::show_why_true(const HalfSpace& said, const std::vector<HalfSpace>& known) {
  const auto& facets = atlas_.policy_bec_half_spaces();
  const auto follows_from = [&](std::vector<HalfSpace> some) {
    some.insert(some.end(), known.begin(), known.end());
    return region_of(some, question_.condition, domain_.num_features()).implies(said);
  };
  std::vector<HalfSpace> needed;
  for (const auto& facet : facets) {
    if (atlas_.prior_cone().implies(facet)) continue;
    if (follows_from({facet})) {
      needed = {facet};
      break;
    }
    needed.push_back(facet);
  }
  for (auto i = needed.size(); i-- > 0;) {
    auto rest = needed;
    rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(i));
    if (follows_from(rest)) needed = std::move(rest);
  }
  constexpr std::size_t kFew = 2;
  for (const auto& facet : needed) {
    if (reply_.examples.size() == kFew) break;
    const auto start = demonstration_of(facet);
    if (start) show(*start, in_words(domain_, facet, facets), contrast_for(atlas_, *start, facet));
  }
}

}  // namespace kith::detail
