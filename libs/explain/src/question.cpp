#include "kith/explain/question.hpp"

#include <algorithm>
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
  Answerer(const Atlas& atlas, const std::string& text, const Question& question)
      : atlas_{atlas}, domain_{atlas.domain()}, text_{text}, question_{question}, scene_{atlas, text, question} {}

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
    }
    return std::move(reply_);
  }

 private:
  [[nodiscard]] MdpIndex last_world() const { return MdpIndex{domain_.num_mdps() - 1}; }
  [[nodiscard]] std::string worlds_text(std::size_t n, std::size_t of) const {
    return std::to_string(n) + " of " + counted(of, "world");
  }

  // "Stopping at the charger happens", or may where chance has a part in it.
  [[nodiscard]] std::string happens(const Happening& happening) const {
    const bool chance = !happening.action && !domain_.is_exact();
    return first_upper(scene_.name_of(happening)) + (chance ? " may happen" : " happens");
  }
  [[nodiscard]] std::string start() const { return domain_.has_map() ? "the map's start" : "the first state"; }
  [[nodiscard]] std::string from_the_start() const {
    return domain_.is_exact() ? "counting from " + start() : "on the likeliest way from " + start();
  }

  // Why there is nothing to show beside it: no way on which it happens more often (or less).
  [[nodiscard]] std::string nothing_else(MdpIndex world, const Happening& happening, bool happens) const {
    if (happens && !happening.action && !domain_.mdp(world).has_feature(happening.feature)) return "there is none";
    if (atlas_.is_tabulated()) return happens ? "nobody's best way has it" : "no way round it is best for anybody";
    const bool tried_others = !happening.action && domain_.is_exact() && !question_.is_about_a_step();
    if (!tried_others) {
      return happens ? "a single other step does not lead to it" : "a single other step does not avoid it";
    }
    if (!happens) return "there is no way round it";
    return domain_.weights().integer[happening.feature] < 0 ? "it would not even if that cost nothing"
                                                            : "no way that ends has it";
  }

  // "it would rather ...: ...", or why there is nothing to compare.
  [[nodiscard]] std::string because(const std::optional<Contrast>& contrast, const std::string& nothing) const {
    if (!contrast) return nothing;
    if (contrast->robot_counts == contrast->alternative_counts) return "both ways count the same";
    return conveyed_by(domain_, *contrast) ? reason(domain_, *contrast) : "both ways are worth the same";
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
  struct World {
    std::optional<DemoIndex> start;   // nothing: the robot is never there
    std::optional<std::size_t> step;  // at which it happens
  };

  void when() {
    const auto& happening = *question_.happening;
    reply_.question = "when: " + scene_.name_of(happening) + scene_.context();
    if (question_.world) return when_in(*question_.world);
    std::vector<World> worlds;
    std::size_t possible = 0, yes = 0;
    for (MdpIndex m{0}; m.value() < domain_.num_mdps(); ++m) {
      World world{scene_.start_in(m), std::nullopt};
      if (world.start) world.step = scene_.step_of(m, atlas_.trajectory(*world.start), happening);
      possible += world.start ? 1U : 0U;
      yes += world.step ? 1U : 0U;
      worlds.push_back(world);
    }
    if (possible == 0) static_cast<void>(scene_.needed_start(last_world()));
    reply_.text = happens(happening) + " in " + worlds_text(yes, possible) + ", " +
                  (question_.is_about_a_step() ? "as the next step" + scene_.spot() : from_the_start()) + ".";
    if (yes == 0 || yes == possible) {
      when_alike(worlds);
    } else {
      when_differing(worlds);
    }
  }

  void when_in(MdpIndex world) {
    const auto& happening = *question_.happening;
    const auto demo = scene_.needed_start(world);
    const auto step = scene_.step_of(world, atlas_.trajectory(demo), happening);
    reply_.text = step ? happens(happening) + " there, with step " + std::to_string(*step + 1) + "."
                       : first_upper(scene_.name_of(happening)) + " does not happen there.";
    show_world(demo, happening, step);
  }

  // The same in all worlds: the one with everything tells why, or the first that can.
  void when_alike(const std::vector<World>& worlds) {
    for (std::size_t m = worlds.size(); m-- > 0;) {
      if (worlds[m].start) return show_world(*worlds[m].start, *question_.happening, worlds[m].step);
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
      if (!worlds[m].step) continue;
      const auto variant = domain_.variant(MdpIndex{m});
      const auto present = static_cast<std::size_t>(std::count(variant.begin(), variant.end(), true));
      for (std::size_t g = 0; g < groups.size(); ++g) {
        auto other = variant;
        other[g] = !other[g];
        const auto found = numbers.find(other);
        if (found == numbers.end() || !worlds[found->second].start || worlds[found->second].step) continue;
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
        if (!worlds[yes].step || !worlds[no].start || worlds[no].step) continue;
        const auto toggled = toggled_groups(domain_, MdpIndex{yes}, MdpIndex{no});
        std::size_t cells = 0;
        for (const auto g : toggled) cells += groups[g].cells.size();
        pairs.push_back({toggled.size(), cells, 0, yes, no});
      }
    }
    return pairs;
  }

  // Each pair tells something new.
  void when_differing(const std::vector<World>& worlds) {
    auto pairs = neighbours(worlds);
    if (pairs.empty()) pairs = all_pairs(worlds);
    std::sort(pairs.begin(), pairs.end());
    constexpr std::size_t kMaxTried = 60;
    std::vector<std::string> told;
    for (std::size_t i = 0; i < std::min(pairs.size(), kMaxTried) && told.size() < kMaxPairs; ++i) {
      const MdpIndex yes{pairs[i].yes};
      const MdpIndex no{pairs[i].no};
      const auto for_it = scene_.contrast_to(*worlds[yes.value()].start, *question_.happening, false);
      const auto against_it = scene_.contrast_to(*worlds[no.value()].start, *question_.happening, true);
      const auto why_yes = because(for_it, nothing_else(yes, *question_.happening, false));
      const auto why_no = because(against_it, nothing_else(no, *question_.happening, true));
      if (std::find(told.begin(), told.end(), why_yes + why_no) != told.end()) continue;
      told.push_back(why_yes + why_no);
      show(*worlds[yes.value()].start, scene_.name_of(yes) + ", it does: " + why_yes, for_it, worlds[yes.value()].step);
      show(*worlds[no.value()].start, scene_.name_of(no) + difference(yes, no) + ", it does not: " + why_no,
           against_it);
    }
  }

  // ", with the charger at (4,1)"; nothing where a list of things would only confuse.
  [[nodiscard]] std::string difference(MdpIndex yes, MdpIndex no) const {
    constexpr std::size_t kFew = 3;
    const auto toggled = toggled_groups(domain_, yes, no);
    return toggled.empty() || toggled.size() > kFew ? "" : ", " + difference_in_words(domain_, no, toggled);
  }

  void show_world(DemoIndex demo, const Happening& happening, const std::optional<std::size_t>& step) {
    const auto contrast = scene_.contrast_to(demo, happening, !step);
    const auto world = atlas_.id(demo).mdp;
    const auto nothing = nothing_else(world, happening, !step);
    show(demo, scene_.name_of(world) + (step ? ", it does: " : ", it does not: ") + because(contrast, nothing),
         contrast, step);
  }

  // --- where ------------------------------------------------------------------
  using Spot = std::pair<std::optional<Cell>, std::string>;  // the name of a state that is on no map

  [[nodiscard]] Spot spot_of(MdpIndex world, StateIndex s) const {
    if (domain_.has_map()) return {domain_.state(world, s).robot, ""};
    return {std::nullopt, domain_.state_name(world, s)};
  }

  void where() {
    const auto& happening = *question_.happening;
    reply_.question = "where: " + scene_.name_of(happening) + scene_.context();
    struct Place {
      std::size_t worlds = 0;
      DemoIndex demo;
      std::size_t step = 0;
      std::string text;  // "at (2,1)"
    };
    std::map<Spot, Place> places;
    const auto first = question_.world ? question_.world->value() : 0;
    const auto end = question_.world ? first + 1 : domain_.num_mdps();
    for (MdpIndex m{first}; m.value() < end; ++m) {
      const auto demo = atlas_.index({m, domain_.initial_state(m)});
      const auto path = atlas_.trajectory(demo);
      std::vector<Spot> seen;
      for (std::size_t t = 0; t < path.actions.size(); ++t) {
        if (!scene_.is_at(m, path.states[t], path.actions[t], happening)) continue;
        const auto spot = spot_of(m, path.states[t]);
        if (std::find(seen.begin(), seen.end(), spot) != seen.end()) continue;
        seen.push_back(spot);
        auto& place = places[spot];
        if (place.worlds++ == 0) place = {1, demo, t, scene_.spot_text(m, path.states[t])};
      }
    }
    if (places.empty()) {
      reply_.text = first_upper(scene_.name_of(happening)) + " happens nowhere on the way from " + start() + ".";
      return when_alike_somewhere();
    }
    std::vector<std::pair<Spot, Place>> sorted(places.begin(), places.end());
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const auto& a, const auto& b) { return a.second.worlds > b.second.worlds; });
    std::vector<std::string> texts;
    for (const auto& [spot, place] : sorted) {
      texts.push_back((texts.empty() || !domain_.has_map() ? place.text : place.text.substr(3)) +
                      (question_.world ? "" : " in " + worlds_text(place.worlds, domain_.num_mdps())));
    }
    reply_.text = happens(happening) + " " + listed(texts) + ", " + from_the_start() + ".";
    for (std::size_t i = 0; i < std::min(sorted.size(), kMaxCells); ++i) {
      const auto& place = sorted[i].second;
      show(place.demo,
           scene_.name_of(atlas_.id(place.demo).mdp) + ", " + place.text + " with step " +
               std::to_string(place.step + 1),
           std::nullopt, place.step);
    }
  }

  void when_alike_somewhere() {
    show_world(scene_.needed_start(question_.world.value_or(last_world())), *question_.happening, std::nullopt);
  }

  // --- why --------------------------------------------------------------------
  void why() {
    const auto world = question_.world.value_or(last_world());
    const auto demo = scene_.needed_start(world);
    reply_.question = "why: " + (question_.happening ? scene_.name_of(*question_.happening) : std::string{"it"}) +
                      (question_.instead ? " and not " + scene_.name_of(*question_.instead) : "") + scene_.context();
    if (question_.is_about_a_step()) {
      why_at(demo);
    } else {
      why_path(demo);
    }
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
    const auto world = atlas_.id(demo).mdp;
    const auto path = atlas_.trajectory(demo);
    const auto& asked = question_.happening ? *question_.happening : *question_.instead;
    const bool does = scene_.step_of(world, path, asked).has_value();
    const auto what = scene_.name_of(asked) + (does ? " happens in " : " does not happen in ") + scene_.name_of(world);
    if (question_.happening && question_.instead && does) {
      return conclude(demo, what, scene_.contrast_to(demo, *question_.instead, true),
                      nothing_else(world, *question_.instead, true));
    }
    conclude(demo, what, scene_.contrast_to(demo, asked, !does), nothing_else(world, asked, !does));
  }

  void conclude(DemoIndex demo, const std::string& says, const std::optional<Contrast>& contrast,
                const std::string& nothing = "there is nothing else to do") {
    reply_.text = first_upper(says) + "; " + because(contrast, nothing) + ".";
    show(demo, because(contrast, says), contrast);
  }

  // --- what -------------------------------------------------------------------
  void what() {
    const auto world = question_.world.value_or(last_world());
    const auto demo = scene_.needed_start(world);
    const auto path = atlas_.trajectory(demo);
    reply_.question = "what" + scene_.context();
    reply_.text =
        first_upper(scene_.place_text(demo)) + " it " + action_words(scene_.action(path.actions.front())) + ".";
    const auto contrast = scene_.best_step(demo);
    show(demo, because(contrast, "there is nothing else to do"), contrast);
  }

  // --- what if ----------------------------------------------------------------
  void what_if() {
    const bool removes = std::any_of(question_.conditions.begin(), question_.conditions.end(),
                                     [](const auto& condition) { return !condition.present; });
    const auto base = question_.world.value_or(removes ? last_world() : MdpIndex{0});
    const auto world = world_with(base);
    const auto toggled = toggled_groups(domain_, base, world);
    const auto changed = difference_in_words(domain_, world, toggled);
    reply_.question = "what if: " + scene_.name_of(base) + " " + changed;
    const auto before = scene_.needed_start(base);
    const auto after = scene_.needed_start(world);
    const auto old_path = atlas_.trajectory(before);
    const auto new_path = atlas_.trajectory(after);
    const auto description = [&](MdpIndex m, const Trajectory& path) {
      return scene_.name_of(m) + ": " + actions_text(domain_, path.actions);
    };
    if (old_path.actions == new_path.actions) {
      reply_.text = first_upper(changed) + " nothing changes.";
      show(before, description(base, old_path));
      show(after, description(world, new_path));
      return;
    }
    auto contrast =
        scene_.best_way(after, [&](const Contrast& c) { return c.alternative.actions == old_path.actions; });
    if (!contrast) contrast = scene_.best_way(after, [](const Contrast&) { return true; });
    reply_.text = first_upper(changed) + " it does " + counts_text(domain_, atlas_.feature_counts(after)) +
                  " in place of " + counts_text(domain_, atlas_.feature_counts(before)) + "; there " +
                  because(contrast, "there is nothing else to do") + ".";
    show(before, description(base, old_path));
    show(after, description(world, new_path), contrast);
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
      const auto where = condition.cell ? " at " + cell_text(domain_, *condition.cell) : std::string{};
      if (!found) {
        detail::fail(text_, condition.place, "E1108", "no world has " + condition.thing + where,
                     "kith inspect shows the map with everything on it");
      }
      if (!changes) {
        detail::fail(
            text_, condition.place, "E1108",
            scene_.name_of(base) + " has " + (condition.present ? "" : "no ") + condition.thing + where + " anyway",
            "name another world: 'in world N'");
      }
    }
    for (MdpIndex m{0}; m.value() < domain_.num_mdps(); ++m) {
      if (domain_.variant(m) == variant) return m;
    }
    detail::fail(text_, question_.conditions.front().place, "E1108", "no world is like that");
  }

  const Atlas& atlas_;
  const Domain& domain_;
  const std::string& text_;
  const Question& question_;
  detail::Scene scene_;
  Reply reply_;
};

}  // namespace

Reply answer_question(const Atlas& atlas, const std::string& question) {
  const auto parsed = detail::parse_question(atlas.domain(), question);
  return Answerer{atlas, question, parsed}.reply();
}

}  // namespace kith
