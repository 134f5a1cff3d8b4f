// Why does the robot do something, what does it do, and how much is a feature worth to it?
#include "answerer.hpp"

#include <algorithm>
#include <limits>

#include "kith/explain/words.hpp"

namespace kith::detail {

void Answerer::why() {
  reply_.question = why_in_words();
  if (question_.is_about_a_step()) {
    why_at(scene_.needed_start(question_.world.value_or(last_world())));
  } else {
    why_path();
  }
}

std::string Answerer::why_in_words() const {
  if (!question_.happening && !question_.instead) return "Why does it do what it does" + scene_.context() + "?";
  if (!question_.happening) return "Why " + does(*question_.instead, true) + scene_.context() + "?";
  auto text = "Why " + does(*question_.happening, false);
  if (question_.instead) {
    const auto verb = verb_of(*question_.instead);
    text += verb.empty() ? " rather than " + scene_.name_of(*question_.instead) : " and not " + verb;
  }
  return text + scene_.context() + "?";
}

void Answerer::why_at(StartIndex start_index) {
  const auto [world, start] = atlas_.id(start_index);
  if (question_.happening) scene_.check_possible(start_index, *question_.happening);
  if (question_.instead) scene_.check_possible(start_index, *question_.instead);
  const auto own = atlas_.action(start_index);
  const bool does = !question_.happening || scene_.is_at(world, start, own, *question_.happening);
  const bool does_instead = question_.instead && scene_.is_at(world, start, own, *question_.instead);
  std::string says = scene_.place_text(start_index) + " it " + action_words(scene_.action(own));
  if (!does || does_instead) {
    says = (does ? "but " : "it does not: ") + says;
    const auto contrast = does ? scene_.contrast_to(start_index, *question_.instead, false)
                               : scene_.contrast_to(start_index, *question_.happening, true);
    return conclude(start_index, says, contrast);
  }
  conclude(
      start_index, says,
      question_.instead ? scene_.contrast_to(start_index, *question_.instead, true) : scene_.best_step(start_index));
}

MdpIndex Answerer::world_to_explain(bool happens) const {
  constexpr std::size_t kMostTried = 64;
  constexpr std::size_t kNoContrast = std::numeric_limits<std::size_t>::max();
  std::optional<MdpIndex> best;
  auto fewest = kNoContrast;  // features that the robot weighs against each other there
  std::size_t tried = 0;
  for (auto m = domain_.num_mdps(); m-- > 0 && tried < kMostTried && fewest > 2;) {
    const auto start = scene_.start_in(MdpIndex{m});
    if (!scene_.is_asked_about(MdpIndex{m}) || !start || look_at(start).happens != happens) continue;
    ++tried;
    const auto contrast = scene_.contrast_to(*start, *question_.happening, !happens);
    const auto conveyed =
        contrast && !is_detour(domain_, *contrast) ? conveyed_by(domain_, *contrast) : std::optional<HalfSpace>{};
    auto weighed = kNoContrast;
    if (conveyed) {
      weighed = 0;
      for (std::size_t k = 0; k < domain_.num_features(); ++k) weighed += conveyed->normal()[k] != 0 ? 1U : 0U;
    }
    if (best && weighed >= fewest) continue;
    best = MdpIndex{m};
    fewest = weighed;
  }
  return best.value_or(last_world());
}

void Answerer::why_path() {
  const bool is_said_to_happen = question_.happening.has_value();
  if (!is_said_to_happen) std::swap(question_.happening, question_.instead);  // look_at() takes the happening
  const auto asked = *question_.happening;
  const auto number = question_.world ? *question_.world : world_to_explain(is_said_to_happen);
  const auto start = scene_.needed_start(number);
  const auto world = look_at(start);
  const bool does = world.happens;
  const auto what = says_that(asked, world.how()) + " in " + scene_.name_of(number) + chance_text(world);
  if (question_.happening && question_.instead && does) {
    return conclude(start, what, scene_.contrast_to(start, *question_.instead, true),
                    nothing_else(number, *question_.instead, true));
  }
  conclude(start, what, scene_.contrast_to(start, asked, !does), nothing_else(number, asked, !does));
}

void Answerer::conclude(StartIndex start, const std::string& says, const std::optional<Contrast>& contrast,
                        const std::string& nothing) {
  reply_.text = first_upper(says) + "; " + because(contrast, nothing) + ".";
  show(start, because(contrast, says), contrast);
}

void Answerer::what() {
  const auto world = question_.world.value_or(last_world());
  const auto start = scene_.needed_start(world);
  if (!question_.is_about_a_step()) return what_on_the_way(start);
  reply_.question = "What does it do" + scene_.context() + "?";
  reply_.text =
      first_upper(scene_.place_text(start)) + " it " + action_words(scene_.action(atlas_.action(start))) + ".";
  const auto contrast = scene_.best_step(start);
  show(start, because(contrast, "it has no other choice"), contrast);
}

// The whole path, and what it comes to.
void Answerer::what_on_the_way(StartIndex start) {
  const auto world = atlas_.id(start).mdp;
  reply_.question = "What does it do in " + scene_.name_of(world) + "?";
  reply_.text =
      "In " + scene_.name_of(world) + " its path has " + counts_text(domain_, atlas_.feature_counts(start)) + ".";
  const auto contrast = scene_.any_best_way(start, [](const Contrast&) { return true; });
  show(start,
       first_upper(actions_text(domain_, world, atlas_.trajectory(start))) + ": " +
           because(contrast, "it has no other choice"),
       contrast);
}

void Answerer::how_much() {
  const auto k = question_.happening->feature;
  const auto name = domain_.wording(k).one;
  const bool is_cost = domain_.weights().integer[k] < 0;
  reply_.question = "How much " + std::string{is_cost ? "does " : "is "} + name + (is_cost ? " cost?" : " worth?");
  std::vector<HalfSpace> told;
  for (const auto& constraint : atlas_.policy_bec_half_spaces()) {
    if (constraint.normal()[k] != 0) told.push_back(constraint);
  }
  std::vector<std::string> sentences;
  const auto each = each_in_words(domain_, told, atlas_.policy_bec_half_spaces());
  for (std::size_t i = 0; i < told.size(); ++i) {
    if (each[i].empty() || std::find(sentences.begin(), sentences.end(), each[i]) != sentences.end()) continue;
    sentences.push_back(each[i]);
    if (atlas_.prior_cone().implies(told[i])) continue;
    if (const auto start = demonstration_of(told[i])) show(*start, each[i], contrast_for(atlas_, *start, told[i]));
  }
  if (sentences.empty() && !told.empty()) {
    reply_.text = "What it does limits how much " + name + (is_cost ? " costs" : " is worth") +
                  ", but there is no short and true sentence about it; 'kith inspect' shows the numbers.";
    return;
  }
  if (sentences.empty()) {
    reply_.text = "Nothing that it does tells how much " + name + (is_cost ? " costs." : " is worth.");
    return;
  }
  reply_.text = "From what it does you can conclude: ";
  for (std::size_t i = 0; i < sentences.size(); ++i) reply_.text += (i > 0 ? "; " : "") + sentences[i];
  reply_.text += ".";
}

std::optional<StartIndex> Answerer::demonstration_of(const HalfSpace& constraint) const {
  const auto number = atlas_.constraints().find(constraint);
  if (!number) return std::nullopt;
  std::optional<StartIndex> best;
  std::size_t least = 0;
  for (StartIndex start{0}; start.value() < atlas_.num_states(); ++start) {
    if (!atlas_.is_candidate(start) || !atlas_.one_step(start).contains(*number)) continue;
    const auto length = atlas_.path(start).size();
    if (best && least <= length) continue;
    best = start;
    least = length;
  }
  return best;
}

}  // namespace kith::detail
