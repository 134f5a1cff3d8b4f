// What the answers to all kinds of questions have in common.
#include "answerer.hpp"

#include <algorithm>
#include <cmath>

#include "kith/explain/reason.hpp"
#include "kith/explain/words.hpp"
#include "kith/mdp/behaviour.hpp"

namespace kith::detail {

std::string first_upper(std::string text) {
  if (!text.empty() && text.front() >= 'a' && text.front() <= 'z') text.front() = static_cast<char>(text.front() - 32);
  return text;
}

Reply Answerer::reply() {
  switch (question_.kind) {
    case Question::Kind::kWhen:
      when();
      break;
    case Question::Kind::kWhere:
      question_.is_about_a_step() ? when() : where();
      break;
    case Question::Kind::kWhy:
      why();
      break;
    case Question::Kind::kWhatIf:
      what_if();
      break;
    case Question::Kind::kWhat:
      what();
      break;
    case Question::Kind::kHowMuch:
      how_much();
      break;
    case Question::Kind::kWhether:
      whether();
      break;
  }
  return std::move(reply_);
}

std::string Answerer::worlds_text(std::size_t n, std::size_t of) const {
  return std::to_string(n) + " of " + counted(of, "world");
}

std::string Answerer::from_the_start() const {
  return scene_.condition() +
         (question_.is_about_a_step() ? " as the next step" + scene_.spot() : " on the way from " + start());
}

std::string Answerer::on_the_way() const {
  return (domain_.is_exact() ? "on the way from " : "on the most likely path from ") + start();
}

std::string Answerer::verb_of(const Happening& happening) const {
  return happening.action ? action_infinitive(scene_.action(*happening.action))
                          : doing(domain_.wording(happening.feature), 1, false);
}

std::string Answerer::says_that(const Happening& happening, Happens how) const {
  if (happening.action) {
    const auto& name = scene_.action(*happening.action);
    return how == Happens::kYes ? "it " + action_words(name)
                                : (how == Happens::kMaybe ? "it may " : "it does not ") + action_infinitive(name);
  }
  const char* const verb = how == Happens::kYes     ? " happens"
                           : how == Happens::kMaybe ? " can happen"
                                                    : " does not happen";
  return scene_.name_of(happening) + verb;
}

std::string Answerer::does(const Happening& happening, bool negated) const {
  const auto verb = verb_of(happening);
  const std::string no = negated ? "not " : "";
  return verb.empty() ? "does " + scene_.name_of(happening) + " " + no + "happen" : "does it " + no + verb;
}

Answerer::World Answerer::look_at(std::optional<StartIndex> start) const {
  World world{start, false, std::nullopt, std::nullopt};
  if (!start) return world;
  world.step = scene_.step_of(atlas_.id(*start).mdp, atlas_.trajectory(*start), *question_.happening);
  world.happens = world.step.has_value();
  if (domain_.is_exact()) return world;
  constexpr double kCertain = 1e-6;
  const auto chance = scene_.chance_of(*start, *question_.happening);
  if (!chance) return world;
  world.happens = *chance > kCertain;
  if (world.happens && *chance < 1.0 - kCertain) world.chance = *chance;
  return world;
}

std::string Answerer::chance_text(const World& world, bool at_most) {
  if (!world.chance) return "";
  constexpr double kSmall = 0.01;
  const double percent = 100.0 * *world.chance;
  if (*world.chance < kSmall) return ", with a chance below 1 %";
  if (*world.chance > 1.0 - kSmall) return ", with a chance above 99 %";
  return std::string{", with a chance of "} + (at_most ? "at most " : "") + std::to_string(std::llround(percent)) +
         " %";
}

std::string Answerer::it_does(const World& world) {
  if (!world.happens) return ", it does not: ";
  return (world.chance ? ", it may" + chance_text(world) : std::string{", it does"}) + ": ";
}

std::string Answerer::nothing_else(MdpIndex world, const Happening& happening, bool happens) const {
  if (happens && !happening.action && !domain_.mdp(world).has_feature(happening.feature)) return "this world has none";
  if (!is_exact(domain_.mdp(world))) {
    return happens ? "no other single step would make it more likely"
                   : "no other single step would make it less likely";
  }
  if (atlas_.find_tables()) return happens ? "it happens on no sensible path" : "it happens on every sensible path";
  const bool tried_others = !happening.action && !question_.is_about_a_step();
  if (!tried_others) return happens ? "no other single step would lead to it" : "no other single step would avoid it";
  if (!happens) return "it happens on every sensible path";
  return domain_.weights().integer[happening.feature] < 0 ? "it would not, even if that were free"
                                                          : "it happens on no sensible path";
}

std::string Answerer::because(const std::optional<Contrast>& contrast, const std::string& nothing) const {
  if (!contrast) return nothing;
  if (contrast->robot_counts == contrast->alternative_counts) return "the other path is just as good";
  if (!conveyed_by(domain_, *contrast)) return "the other path is worth just as much to it";
  if (has_several(*contrast) && is_detour(domain_, *contrast)) return detour(*contrast);
  // Who asks why is told all of it, too long as it is to keep in mind.
  const auto said = reason(atlas_, *contrast);
  const auto all =
      said == kAllInAll ? in_words(domain_, constraint_of(contrast->robot_counts, contrast->alternative_counts)) : "";
  return all.empty() ? said : all;
}

bool Answerer::has_several(const Contrast& contrast) const {
  const auto more = contrast.alternative_counts - contrast.robot_counts;
  return std::count_if(more.begin(), more.end(), [](std::int64_t n) { return n != 0; }) > 1;
}

std::string Answerer::detour(const Contrast& contrast) const {
  if (!is_exact(domain_.mdp(atlas_.id(contrast.start).mdp))) {
    return "the best other step has no advantage: " +
           on_average_in_words(domain_, contrast.robot_counts - contrast.alternative_counts);
  }
  std::vector<std::string> added, missed;
  const auto counts = whole_counts(domain_, contrast.alternative_counts - contrast.robot_counts);
  for (std::size_t k = 0; k < domain_.num_features(); ++k) {
    const auto more = counts[k];
    if (more > 0) added.push_back(times(domain_.wording(k), more));
    if (more < 0) missed.push_back(times(domain_.wording(k), -more));
  }
  std::string text = "the best other path has no advantage: it ";
  if (!added.empty()) text += "adds " + listed(added);
  if (!missed.empty()) text += (added.empty() ? "lacks " : " and lacks ") + listed(missed);
  return text;
}

void Answerer::show(StartIndex start, std::string text, const std::optional<Contrast>& contrast,
                    std::optional<std::size_t> step) {
  Example example{start, atlas_.trajectory(start), std::move(text), std::nullopt, step};
  if (contrast) {
    example.path = contrast->robot;
    example.alternative = contrast->alternative;
    example.decisive = contrast->decisive;
  }
  reply_.examples.push_back(std::move(example));
}

}  // namespace kith::detail
