#include "kith/explain/question.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "kith/explain/contrast.hpp"
#include "kith/explain/words.hpp"
#include "question_parser.hpp"
#include "scene.hpp"

namespace kith {
namespace {

using detail::Happening;
using detail::Question;

constexpr std::size_t kMaxPairs = 3;
constexpr std::size_t kMaxCells = 4;

std::string first_upper(std::string text) {
  if (!text.empty() && text.front() >= 'a' && text.front() <= 'z') text.front() = static_cast<char>(text.front() - 32);
  return text;
}

// Answers one question.
class Answerer {
 public:
  Answerer(const Atlas& atlas, const std::string& text, Question question)
      : atlas_{atlas},
        domain_{atlas.domain()},
        map_{domain_.map()},
        text_{text},
        question_{std::move(question)},
        scene_{atlas, text, question_} {}

  Reply reply() {
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
    }
    return std::move(reply_);
  }

 private:
  [[nodiscard]] MdpIndex last_world() const { return MdpIndex{domain_.num_mdps() - 1}; }
  [[nodiscard]] std::string worlds_text(std::size_t n, std::size_t of) const {
    return std::to_string(n) + " of " + counted(of, "world");
  }

  [[nodiscard]] std::string start() const { return map_ ? "the map's start" : "the first state"; }
  // Where "in 6 of 16 worlds" is about.
  [[nodiscard]] std::string from_the_start() const {
    return question_.is_about_a_step() ? " as the next step" + scene_.spot() : " on the way from " + start();
  }
  [[nodiscard]] std::string on_the_way() const {
    return (domain_.is_exact() ? "on the way from " : "on the likeliest way from ") + start();
  }

  // --- the question in words --------------------------------------------------
  // "stop at the charger"; nothing for features without a verb.
  [[nodiscard]] std::string verb_of(const Happening& happening) const {
    return happening.action ? action_infinitive(scene_.action(*happening.action))
                            : doing(domain_.wording(happening.feature), 1, false);
  }
  // "does it stop at the charger", "does a stair not happen".
  [[nodiscard]] std::string does(const Happening& happening, bool negated) const {
    const auto verb = verb_of(happening);
    const std::string no = negated ? "not " : "";
    return verb.empty() ? "does " + scene_.name_of(happening) + " " + no + "happen" : "does it " + no + verb;
  }

  // --- chances ----------------------------------------------------------------
  // How it goes in one world: whether it happens, at which step of the path shown, and with which chance.
  struct World {
    std::optional<DemoIndex> start;   // nothing: the robot is never there
    bool happens = false;             // or can happen
    std::optional<std::size_t> step;  // of the path shown
    std::optional<double> chance;     // where chance has a part in it
  };

  [[nodiscard]] World look_at(std::optional<DemoIndex> start) const {
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

  // ", with a chance of 18 %"; nothing where it is certain.
  [[nodiscard]] static std::string chance_text(const World& world, const std::string& before = ", ") {
    if (!world.chance) return "";
    constexpr double kSmall = 0.01;
    const double percent = 100.0 * *world.chance;
    if (*world.chance < kSmall) return before + "with a chance below 1 %";
    if (*world.chance > 1.0 - kSmall) return before + "with a chance above 99 %";
    return before + "with a chance of " + std::to_string(std::llround(percent)) + " %";
  }

  [[nodiscard]] static std::string it_does(const World& world) {
    if (!world.happens) return ", it does not: ";
    return (world.chance ? ", it may" + chance_text(world, " ") : std::string{", it does"}) + ": ";
  }

  // Why there is nothing to show beside it: no way on which it happens more often (or less).
  [[nodiscard]] std::string nothing_else(MdpIndex world, const Happening& happening, bool happens) const {
    if (happens && !happening.action && !domain_.mdp(world).has_feature(happening.feature)) return "there is none";
    if (!domain_.is_exact()) {
      return happens ? "no other single step would make it likelier" : "no other single step would make it less likely";
    }
    if (atlas_.is_tabulated()) return happens ? "no sensible path has it" : "every sensible path has it";
    const bool tried_others = !happening.action && !question_.is_about_a_step();
    if (!tried_others) {
      return happens ? "no other single step would lead to it" : "no other single step would avoid it";
    }
    if (!happens) return "every sensible path has it";
    return domain_.weights().integer[happening.feature] < 0 ? "it would not, even if that were free"
                                                            : "no sensible path has it";
  }

  // "it would rather ...: ...", or why there is nothing to compare.
  [[nodiscard]] std::string because(const std::optional<Contrast>& contrast, const std::string& nothing) const {
    if (!contrast) return nothing;
    if (contrast->robot_counts == contrast->alternative_counts) return "both paths count the same";
    if (!conveyed_by(domain_, *contrast)) return "both paths are worth the same";
    return has_several(*contrast) && is_detour(domain_, *contrast) ? detour(*contrast) : reason(domain_, *contrast);
  }

  [[nodiscard]] bool has_several(const Contrast& contrast) const {
    const auto more = contrast.alternative_counts - contrast.robot_counts;
    return std::count_if(more.begin(), more.end(), [](std::int64_t n) { return n != 0; }) > 1;
  }

  // What a detour would add and leave out.
  [[nodiscard]] std::string detour(const Contrast& contrast) const {
    if (!domain_.is_exact()) {
      return "the best other step has no advantage: " +
             on_average_in_words(domain_, contrast.robot_counts - contrast.alternative_counts);
    }
    std::vector<std::string> added, missed;
    for (std::size_t k = 0; k < domain_.num_features(); ++k) {
      const auto more = contrast.alternative_counts[k] - contrast.robot_counts[k];
      if (more > 0) added.push_back(times(domain_.wording(k), more));
      if (more < 0) missed.push_back(times(domain_.wording(k), -more));
    }
    std::string text = "the best other path has no advantage: it ";
    if (!added.empty()) text += "adds " + listed(added);
    if (!missed.empty()) text += (added.empty() ? "lacks " : " and lacks ") + listed(missed);
    return text;
  }

  void show(DemoIndex demo, std::string text, const std::optional<Contrast>& contrast = std::nullopt,
            std::optional<std::size_t> step = std::nullopt) {
    Example example{demo, atlas_.trajectory(demo), std::move(text), std::nullopt, step};
    if (contrast) {
      example.path = contrast->robot;
      example.alternative = contrast->alternative;
      example.decisive = contrast->decisive;
    }
    reply_.examples.push_back(std::move(example));
  }

  // --- when -------------------------------------------------------------------
  void when() {
    const auto& happening = *question_.happening;
    reply_.question = "When " + does(happening, question_.negated) + scene_.context() + "?";
    if (question_.world) return when_in(*question_.world);
    std::vector<World> worlds;
    std::size_t possible = 0, yes = 0;
    double most = 0.0;
    for (MdpIndex m{0}; m.value() < domain_.num_mdps(); ++m) {
      worlds.push_back(look_at(scene_.start_in(m)));
      const auto& world = worlds.back();
      possible += world.start ? 1U : 0U;
      yes += world.happens ? 1U : 0U;
      if (world.chance) most = std::max(most, *world.chance);
    }
    if (possible == 0) static_cast<void>(scene_.needed_start(last_world()));
    const auto n = question_.negated ? possible - yes : yes;
    const std::string verb = question_.negated ? " does not happen in "
                             : most > 0.0      ? " can happen in "
                                               : " happens in ";
    reply_.text = first_upper(scene_.name_of(happening)) + verb + worlds_text(n, possible) + from_the_start();
    if (most > 0.0 && !question_.negated) {
      reply_.text += chance_text({std::nullopt, true, std::nullopt, most}) + (yes > 1 ? " at most" : "");
    }
    reply_.text += ".";
    if (yes == 0 || yes == possible) {
      when_alike(worlds);
    } else {
      when_differing(worlds);
    }
  }

  void when_in(MdpIndex number) {
    const auto& happening = *question_.happening;
    const auto world = look_at(scene_.needed_start(number));
    reply_.text = first_upper(scene_.name_of(happening));
    if (!world.happens) {
      reply_.text += " does not happen there.";
    } else if (world.chance) {
      reply_.text += " can happen there" + chance_text(world) + ".";
    } else {
      reply_.text +=
          " happens there" + (world.step ? ", in step " + std::to_string(*world.step + 1) : std::string{}) + ".";
    }
    show_world(world);
  }

  // The same in all worlds: the one with everything tells why, or the first that can.
  void when_alike(const std::vector<World>& worlds) {
    for (std::size_t m = worlds.size(); m-- > 0;) {
      if (worlds[m].start) return show_world(worlds[m]);
    }
  }

  // Two worlds that differ in little and in whether it happens.
  struct Pair {
    std::size_t num_groups, num_cells, num_present, yes, no;
    auto operator<=>(const Pair&) const = default;
  };

  [[nodiscard]] std::vector<Pair> neighbours(const std::vector<World>& worlds) const {
    const auto groups = domain_.optional_groups();
    std::map<std::vector<bool>, std::size_t> numbers;
    for (std::size_t m = 0; m < worlds.size(); ++m) numbers.emplace(domain_.variant(MdpIndex{m}), m);
    std::vector<Pair> pairs;
    for (std::size_t m = 0; m < worlds.size(); ++m) {
      if (!worlds[m].happens) continue;
      const auto variant = domain_.variant(MdpIndex{m});
      const auto present = static_cast<std::size_t>(std::count(variant.begin(), variant.end(), true));
      for (std::size_t g = 0; g < groups.size(); ++g) {
        auto other = variant;
        other[g] = !other[g];
        const auto found = numbers.find(other);
        if (found == numbers.end() || !worlds[found->second].start || worlds[found->second].happens) continue;
        pairs.push_back({1, groups[g].cells.size(), present, m, found->second});
      }
    }
    return pairs;
  }

  // Of a sample of all possible worlds none may be neighbours.
  [[nodiscard]] std::vector<Pair> all_pairs(const std::vector<World>& worlds) const {
    constexpr std::size_t kMostWorlds = 128;  // more have neighbours, or it takes too long
    const auto groups = domain_.optional_groups();
    std::vector<Pair> pairs;
    const auto n = std::min(worlds.size(), kMostWorlds);
    for (std::size_t yes = 0; yes < n; ++yes) {
      for (std::size_t no = 0; no < n; ++no) {
        if (!worlds[yes].happens || !worlds[no].start || worlds[no].happens) continue;
        const auto toggled = toggled_groups(domain_, MdpIndex{yes}, MdpIndex{no});
        std::size_t cells = 0;
        for (const auto g : toggled) cells += groups[g].cells.size();
        pairs.push_back({toggled.size(), cells, 0, yes, no});
      }
    }
    return pairs;
  }

  // Each pair tells something new. Pairs whose reasons compare with detours only where there are no others.
  void when_differing(const std::vector<World>& worlds) {
    auto pairs = neighbours(worlds);
    if (pairs.empty()) pairs = all_pairs(worlds);
    std::sort(pairs.begin(), pairs.end());
    constexpr std::size_t kMaxTried = 60;
    if (pairs.size() > kMaxTried) pairs.resize(kMaxTried);
    if (show_pairs(worlds, pairs, false) == 0) static_cast<void>(show_pairs(worlds, pairs, true));
  }

  std::size_t show_pairs(const std::vector<World>& worlds, const std::vector<Pair>& pairs, bool with_detours) {
    std::vector<std::string> told;
    for (const auto& pair : pairs) {
      if (told.size() == kMaxPairs) break;
      const auto& [yes, no] = std::pair{worlds[pair.yes], worlds[pair.no]};
      const auto for_it = scene_.contrast_to(*yes.start, *question_.happening, false);
      const auto against_it = scene_.contrast_to(*no.start, *question_.happening, true);
      const bool has_detour =
          (for_it && is_detour(domain_, *for_it)) || (against_it && is_detour(domain_, *against_it));
      if (has_detour && !with_detours) continue;
      const auto why_yes = because(for_it, nothing_else(MdpIndex{pair.yes}, *question_.happening, false));
      const auto why_no = because(against_it, nothing_else(MdpIndex{pair.no}, *question_.happening, true));
      if (std::find(told.begin(), told.end(), why_yes + why_no) != told.end()) continue;
      told.push_back(why_yes + why_no);
      // What was asked about comes first.
      const auto& first = question_.negated ? no : yes;
      const auto& second = question_.negated ? yes : no;
      show_one_of_pair(first, question_.negated ? against_it : for_it, question_.negated ? why_no : why_yes, "");
      show_one_of_pair(second, question_.negated ? for_it : against_it, question_.negated ? why_yes : why_no,
                       difference(atlas_.id(*first.start).mdp, atlas_.id(*second.start).mdp));
    }
    return told.size();
  }

  void show_one_of_pair(const World& world, const std::optional<Contrast>& contrast, const std::string& why,
                        const std::string& differs) {
    show(*world.start, scene_.name_of(atlas_.id(*world.start).mdp) + differs + it_does(world) + why, contrast,
         world.step);
  }

  // ", with the charger at (4,1)"; nothing where a list of things would only confuse.
  [[nodiscard]] std::string difference(MdpIndex from, MdpIndex to) const {
    constexpr std::size_t kFew = 3;
    const auto toggled = toggled_groups(domain_, from, to);
    return toggled.empty() || toggled.size() > kFew ? "" : ", " + difference_in_words(domain_, to, toggled);
  }

  void show_world(const World& world) {
    const auto& happening = *question_.happening;
    const auto contrast = scene_.contrast_to(*world.start, happening, !world.happens);
    const auto number = atlas_.id(*world.start).mdp;
    show(*world.start,
         scene_.name_of(number) + it_does(world) + because(contrast, nothing_else(number, happening, !world.happens)),
         contrast, world.step);
  }

  // --- where ------------------------------------------------------------------
  using Spot = std::pair<std::optional<Cell>, std::string>;  // the name of a state that is on no map

  [[nodiscard]] Spot spot_of(MdpIndex world, StateIndex s) const {
    if (map_) return {map_->state(world, s).robot, ""};
    return {std::nullopt, domain_.state_name(world, s)};
  }

  // Where something happens on the ways from the start, or, if the question is negated, where the robot comes by and it
  // does not.
  struct Place {
    std::size_t worlds = 0;   // in which it does (not)
    std::size_t visited = 0;  // worlds in which the robot comes by
    DemoIndex demo;
    std::size_t step = 0;
    std::string text;  // "at (2,1)"
  };

  void add_places(MdpIndex world, std::map<Spot, Place>& places) const {
    const auto demo = atlas_.index({world, domain_.initial_state(world)});
    const auto path = atlas_.trajectory(demo);
    std::map<Spot, std::optional<std::size_t>> seen;  // and at which step it happens
    std::map<Spot, std::size_t> first_visit;
    for (std::size_t t = 0; t < path.actions.size(); ++t) {
      const auto spot = spot_of(world, path.states[t]);
      first_visit.emplace(spot, t);
      auto& step = seen[spot];
      if (!step && scene_.is_at(world, path.states[t], path.actions[t], *question_.happening)) step = t;
    }
    for (const auto& [spot, step] : seen) {
      auto& place = places[spot];
      ++place.visited;
      if (step.has_value() == question_.negated) continue;
      if (place.worlds++ > 0) continue;
      place.demo = demo;
      place.step = step.value_or(first_visit.at(spot));
      place.text = scene_.spot_text(world, path.states[place.step]);
    }
  }

  void where() {
    const auto& happening = *question_.happening;
    reply_.question = "Where " + does(happening, question_.negated) + scene_.context() + "?";
    std::map<Spot, Place> places;
    const auto first = question_.world ? question_.world->value() : 0;
    const auto end = question_.world ? first + 1 : domain_.num_mdps();
    for (MdpIndex m{first}; m.value() < end; ++m) add_places(m, places);
    std::erase_if(places, [](const auto& entry) { return entry.second.worlds == 0; });
    const auto name = first_upper(scene_.name_of(happening));
    if (places.empty()) {
      reply_.text = name + (question_.negated ? " happens everywhere " : " happens nowhere ") + on_the_way() + ".";
      return show_world(look_at(scene_.needed_start(question_.world.value_or(last_world()))));
    }
    std::vector<Place> sorted;
    sorted.reserve(places.size());
    for (const auto& [spot, place] : places) sorted.push_back(place);
    std::stable_sort(sorted.begin(), sorted.end(), [](const Place& a, const Place& b) { return a.worlds > b.worlds; });
    const std::string verb = question_.negated    ? " does not happen "
                             : domain_.is_exact() ? " happens "
                                                  : " can happen ";
    reply_.text = name + verb + listed(place_texts(sorted)) + ", " + on_the_way() + ".";
    for (std::size_t i = 0; i < std::min(sorted.size(), kMaxCells); ++i) {
      const auto& place = sorted[i];
      show(place.demo,
           scene_.name_of(atlas_.id(place.demo).mdp) + ", " + place.text + ", step " + std::to_string(place.step + 1),
           std::nullopt, place.step);
    }
  }

  // "at (4,1) in 16 of 64 worlds", "(3,2) in 2 of 64 worlds"; of many the first ones.
  [[nodiscard]] std::vector<std::string> place_texts(const std::vector<Place>& places) const {
    constexpr std::size_t kMost = 12;
    std::vector<std::string> texts;
    for (const auto& place : places) {
      if (texts.size() == kMost) break;
      const auto of = question_.negated ? place.visited : domain_.num_mdps();
      texts.push_back((texts.empty() || !map_ ? place.text : place.text.substr(3)) +
                      (question_.world ? "" : " in " + worlds_text(place.worlds, of)));
    }
    if (question_.negated && !question_.world) texts.front() += " that lead there";
    if (places.size() > kMost) texts.push_back(counted(places.size() - kMost, "other place"));
    return texts;
  }

  // --- why --------------------------------------------------------------------
  void why() {
    const auto world = question_.world.value_or(last_world());
    const auto demo = scene_.needed_start(world);
    reply_.question = why_in_words();
    if (question_.is_about_a_step()) {
      why_at(demo);
    } else {
      why_path(demo);
    }
  }

  // "Why does it go left rather than go up at (2,1)?", "Why does it not stop at the charger?".
  [[nodiscard]] std::string why_in_words() const {
    if (!question_.happening && !question_.instead) return "Why does it do what it does" + scene_.context() + "?";
    if (!question_.happening) return "Why " + does(*question_.instead, true) + scene_.context() + "?";
    auto text = "Why " + does(*question_.happening, false);
    if (question_.instead) {
      const auto verb = verb_of(*question_.instead);
      text += verb.empty() ? " rather than " + scene_.name_of(*question_.instead) : " and not " + verb;
    }
    return text + scene_.context() + "?";
  }

  // About one step.
  void why_at(DemoIndex demo) {
    const auto [world, start] = atlas_.id(demo);
    if (question_.happening) scene_.check_possible(demo, *question_.happening);
    if (question_.instead) scene_.check_possible(demo, *question_.instead);
    const auto own = atlas_.trajectory(demo).actions.front();
    const bool does = !question_.happening || scene_.is_at(world, start, own, *question_.happening);
    const bool does_instead = question_.instead && scene_.is_at(world, start, own, *question_.instead);
    std::string says = scene_.place_text(demo) + " it " + action_words(scene_.action(own));
    if (!does || does_instead) {
      says = (does ? "but " : "it does not: ") + says;
      const auto contrast = does_instead ? scene_.contrast_to(demo, *question_.instead, false)
                                         : scene_.contrast_to(demo, *question_.happening, true);
      return conclude(demo, says, contrast);
    }
    conclude(demo, says,
             question_.instead ? scene_.contrast_to(demo, *question_.instead, true) : scene_.best_step(demo));
  }

  // About the path from the map's start.
  void why_path(DemoIndex demo) {
    const auto number = atlas_.id(demo).mdp;
    const auto& asked = question_.happening ? *question_.happening : *question_.instead;
    if (!question_.happening) std::swap(question_.happening, question_.instead);  // look_at() takes the happening
    const auto world = look_at(demo);
    const bool does = world.happens;
    const auto what = scene_.name_of(asked) +
                      (does ? (world.chance ? " can happen in " : " happens in ") : " does not happen in ") +
                      scene_.name_of(number) + chance_text(world);
    if (question_.happening && question_.instead && does) {
      return conclude(demo, what, scene_.contrast_to(demo, *question_.instead, true),
                      nothing_else(number, *question_.instead, true));
    }
    conclude(demo, what, scene_.contrast_to(demo, asked, !does), nothing_else(number, asked, !does));
  }

  void conclude(DemoIndex demo, const std::string& says, const std::optional<Contrast>& contrast,
                const std::string& nothing = "it has no other choice") {
    reply_.text = first_upper(says) + "; " + because(contrast, nothing) + ".";
    show(demo, because(contrast, says), contrast);
  }

  // --- what -------------------------------------------------------------------
  void what() {
    const auto world = question_.world.value_or(last_world());
    const auto demo = scene_.needed_start(world);
    const auto path = atlas_.trajectory(demo);
    reply_.question = "What does it do" + scene_.context() + "?";
    reply_.text =
        first_upper(scene_.place_text(demo)) + " it " + action_words(scene_.action(path.actions.front())) + ".";
    const auto contrast = scene_.best_step(demo);
    show(demo, because(contrast, "it has no other choice"), contrast);
  }

  // --- what if ----------------------------------------------------------------
  void what_if() {
    const bool removes = std::any_of(question_.conditions.begin(), question_.conditions.end(),
                                     [](const auto& condition) { return !condition.present; });
    auto base = question_.world.value_or(removes ? last_world() : MdpIndex{0});
    auto world = world_with(base);
    std::string elsewhere;
    if (!question_.world && !question_.is_about_a_step()) {
      const auto effects = worlds_it_matters_in(base, world);
      elsewhere = effects.matters == 0
                      ? "; nor does it in any other world"
                      : " (it changes the path in " + worlds_text(effects.matters, effects.tried) + ")";
      if (effects.matters > 0) {
        base = effects.base;
        world = effects.world;
      }
    }
    const auto changed = difference_in_words(domain_, world, toggled_groups(domain_, base, world));
    reply_.question = "What happens in " + scene_.name_of(base) + " " + changed + scene_.spot() + "?";
    const auto before = scene_.needed_start(base);
    const auto after = scene_.needed_start(world);
    const auto old_path = atlas_.trajectory(before);
    const auto new_path = atlas_.trajectory(after);
    const auto description = [&](MdpIndex m, const Trajectory& path) {
      return scene_.name_of(m) + ": " + actions_text(domain_, path.actions);
    };
    if (old_path.actions == new_path.actions) {
      reply_.text = first_upper(changed) + " nothing changes in " + scene_.name_of(base) + elsewhere + ".";
      show(before, description(base, old_path));
      show(after, description(world, new_path));
      return;
    }
    auto contrast =
        scene_.any_best_way(after, [&](const Contrast& c) { return c.alternative.actions == old_path.actions; });
    if (!contrast) contrast = scene_.best_way(after, [](const Contrast&) { return true; });
    if (!contrast) contrast = scene_.any_best_way(after, [](const Contrast&) { return true; });
    reply_.text = first_upper(changed) + " its path has " + counts_text(domain_, atlas_.feature_counts(after)) +
                  " instead of " + counts_text(domain_, atlas_.feature_counts(before)) + elsewhere + "; there " +
                  because(contrast, "it has no other choice") + ".";
    show(before, description(base, old_path));
    show(after, description(world, new_path), contrast);
  }

  // In how many pairs of worlds that differ in what was asked the paths differ, and the pair nearest to the given one.
  struct Effects {
    std::size_t tried = 0, matters = 0;
    MdpIndex base, world;
  };

  [[nodiscard]] Effects worlds_it_matters_in(MdpIndex base, MdpIndex world) const {
    std::map<std::vector<bool>, MdpIndex> numbers;
    for (MdpIndex m{0}; m.value() < domain_.num_mdps(); ++m) numbers.emplace(domain_.variant(m), m);
    const auto asked = toggled_groups(domain_, base, world);
    const auto there = domain_.variant(world);
    Effects effects{0, 0, base, world};
    std::optional<std::size_t> nearest;
    for (const auto& [variant, m] : numbers) {
      auto other = variant;
      for (const auto g : asked) other[g] = there[g];
      const auto found = numbers.find(other);
      if (other == variant || found == numbers.end()) continue;
      ++effects.tried;
      const auto path = [&](MdpIndex of) { return atlas_.trajectory(atlas_.index({of, domain_.initial_state(of)})); };
      if (path(m).actions == path(found->second).actions) continue;
      ++effects.matters;
      const auto distance = toggled_groups(domain_, base, m).size();
      if (nearest && *nearest <= distance) continue;
      nearest = distance;
      effects.base = m;
      effects.world = found->second;
    }
    return effects;
  }

  // --- how much ---------------------------------------------------------------
  // What people can conclude about a feature's weight from all that the robot does, each with a demonstration.
  void how_much() {
    const auto k = question_.happening->feature;
    const auto name = domain_.wording(k).one;
    const bool is_cost = domain_.weights().integer[k] < 0;
    reply_.question = "How much " + std::string{is_cost ? "does " : "is "} + name + (is_cost ? " cost?" : " worth?");
    std::vector<std::string> sentences;
    for (const auto& constraint : atlas_.policy_bec_half_spaces()) {
      if (constraint.normal()[k] == 0) continue;
      sentences.push_back(in_words(domain_, constraint));
      if (atlas_.prior_cone().implies(constraint)) continue;
      if (const auto demo = demonstration_of(constraint)) {
        show(*demo, sentences.back(), contrast_for(atlas_, *demo, constraint));
      }
    }
    if (sentences.empty()) {
      reply_.text = "Nothing that it does tells how much " + name + (is_cost ? " costs." : " is worth.");
      return;
    }
    reply_.text = "From what it does you can conclude: ";
    for (std::size_t i = 0; i < sentences.size(); ++i) reply_.text += (i > 0 ? "; " : "") + sentences[i];
    reply_.text += ".";
  }

  // The shortest demonstration that conveys a constraint.
  [[nodiscard]] std::optional<DemoIndex> demonstration_of(const HalfSpace& constraint) const {
    const auto number = atlas_.constraints().find(constraint);
    if (!number) return std::nullopt;
    std::optional<DemoIndex> best;
    std::size_t least = 0;
    for (DemoIndex demo{0}; demo.value() < atlas_.num_demos(); ++demo) {
      if (!atlas_.is_candidate(demo) || !atlas_.one_step(demo).contains(*number)) continue;
      const auto length = atlas_.path(demo).size();
      if (best && least <= length) continue;
      best = demo;
      least = length;
    }
    return best;
  }

  [[nodiscard]] MdpIndex world_with(MdpIndex base) const {
    const auto groups = domain_.optional_groups();
    auto variant = domain_.variant(base);
    for (const auto& condition : question_.conditions) {
      bool found = false, changes = false;
      for (std::size_t g = 0; g < groups.size(); ++g) {
        const auto& cells = groups[g].cells;
        if (groups[g].name != condition.thing) continue;
        if (condition.cell && std::find(cells.begin(), cells.end(), *condition.cell) == cells.end()) continue;
        found = true;
        changes = changes || variant[g] != condition.present;
        variant[g] = condition.present;
      }
      const auto where = condition.cell ? " at " + cell_text(*map_, *condition.cell) : std::string{};
      if (!found) {
        detail::fail(text_, condition.place, "E1108", "no world has " + condition.thing + where, Remedy::kShowMap);
      }
      if (!changes) {
        detail::fail(
            text_, condition.place, "E1108",
            scene_.name_of(base) + (condition.present ? " already has " : " has no ") + condition.thing + where,
            "name another world: 'in world N'");
      }
    }
    for (MdpIndex m{0}; m.value() < domain_.num_mdps(); ++m) {
      if (domain_.variant(m) == variant) return m;
    }
    detail::fail(text_, question_.conditions.front().place, "E1108", "no world is like that",
                 "its worlds are a sample: ask 'in world N' about another one");
  }

  const Atlas& atlas_;
  const Domain& domain_;
  std::optional<GridMap> map_;  // there is one if the question names a cell
  const std::string& text_;
  Question question_;
  detail::Scene scene_;
  Reply reply_;
};

}  // namespace

Reply answer_question(const Atlas& atlas, const std::string& question) {
  return Answerer{atlas, question, detail::parse_question(atlas.domain(), question)}.reply();
}

}  // namespace kith
