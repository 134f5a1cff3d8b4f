#include "kith/explain/question.hpp"

#include <algorithm>
#include <map>
#include <tuple>

#include "kith/explain/contrast.hpp"
#include "kith/explain/reason.hpp"
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
        question_.cell ? when() : where();
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
  [[nodiscard]] static std::string number(MdpIndex world) { return std::to_string(world.value()); }
  [[nodiscard]] MdpIndex last_world() const { return MdpIndex{domain_.num_mdps() - 1}; }
  [[nodiscard]] std::string worlds_text(std::size_t n, std::size_t of) const {
    return std::to_string(n) + " of " + counted(of, "world");
  }

  // "it would rather ...: ...", or why there is nothing to compare.
  [[nodiscard]] std::string because(const std::optional<Contrast>& contrast, const std::string& nothing) const {
    if (!contrast) return nothing;
    if (contrast->robot_counts == contrast->alternative_counts) return "both ways count the same";
    return reason(domain_, contrast->robot_counts, contrast->alternative_counts);
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
    reply_.text = first_upper(scene_.name_of(happening)) + " happens in " + worlds_text(yes, possible) +
                  (question_.cell ? ", as the next step at " + cell_text(domain_, *question_.cell)
                                  : ", counting from the map's start") +
                  ".";
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
    reply_.text =
        step ? first_upper(scene_.name_of(happening)) + " happens there, with step " + std::to_string(*step + 1) + "."
             : first_upper(scene_.name_of(happening)) + " does not happen there.";
    show_world(demo, happening, step);
  }

  // The same in all worlds: the one with everything tells why, or the first that can.
  void when_alike(const std::vector<World>& worlds) {
    for (std::size_t m = worlds.size(); m-- > 0;) {
      if (worlds[m].start) return show_world(*worlds[m].start, *question_.happening, worlds[m].step);
    }
  }

  // Worlds that differ in one group and in whether it happens; each pair tells something new.
  void when_differing(const std::vector<World>& worlds) {
    struct Pair {
      std::size_t num_cells, num_present, yes, no;
      auto operator<=>(const Pair&) const = default;
    };
    const auto groups = domain_.optional_groups();
    std::map<std::vector<bool>, std::size_t> numbers;
    for (std::size_t m = 0; m < worlds.size(); ++m) numbers.emplace(domain_.variant(MdpIndex{m}), m);
    std::vector<Pair> pairs;
    for (std::size_t m = 0; m < worlds.size(); ++m) {
      if (!worlds[m].step) continue;
      const auto variant = domain_.variant(MdpIndex{m});
      for (std::size_t g = 0; g < groups.size(); ++g) {
        auto other = variant;
        other[g] = !other[g];
        const auto found = numbers.find(other);
        if (found == numbers.end() || !worlds[found->second].start || worlds[found->second].step) continue;
        const auto present = static_cast<std::size_t>(std::count(variant.begin(), variant.end(), true));
        pairs.push_back({groups[g].cells.size(), present, m, found->second});
      }
    }
    std::sort(pairs.begin(), pairs.end());
    constexpr std::size_t kMaxTried = 60;
    std::vector<std::string> told;
    for (std::size_t i = 0; i < std::min(pairs.size(), kMaxTried) && told.size() < kMaxPairs; ++i) {
      const MdpIndex yes{pairs[i].yes};
      const MdpIndex no{pairs[i].no};
      const auto for_it = scene_.contrast_to(*worlds[yes.value()].start, *question_.happening, false);
      const auto against_it = scene_.contrast_to(*worlds[no.value()].start, *question_.happening, true);
      const auto toggled = toggled_groups(domain_, yes, no);
      const auto changed = difference_in_words(domain_, no, toggled);
      const auto why_yes = because(for_it, "no way round it is best for anybody");
      const auto why_no = because(against_it, "nobody's best way has it");
      if (std::find(told.begin(), told.end(), why_yes + why_no) != told.end()) continue;
      told.push_back(why_yes + why_no);
      show(*worlds[yes.value()].start, "world " + number(yes) + ", it does: " + why_yes, for_it,
           worlds[yes.value()].step);
      show(*worlds[no.value()].start, "world " + number(no) + ", " + changed + ", it does not: " + why_no, against_it);
    }
  }

  void show_world(DemoIndex demo, const Happening& happening, const std::optional<std::size_t>& step) {
    const auto contrast = scene_.contrast_to(demo, happening, !step);
    const auto world = atlas_.id(demo).mdp;
    const auto nothing = step ? "no way round it is best for anybody" : "nobody's best way has it";
    show(demo, "world " + number(world) + (step ? ", it does: " : ", it does not: ") + because(contrast, nothing),
         contrast, step);
  }

  // --- where ------------------------------------------------------------------
  void where() {
    const auto& happening = *question_.happening;
    reply_.question = "where: " + scene_.name_of(happening) + scene_.context();
    struct Place {
      std::size_t worlds = 0;
      DemoIndex demo;
      std::size_t step = 0;
    };
    std::map<Cell, Place> places;
    const auto first = question_.world ? question_.world->value() : 0;
    const auto end = question_.world ? first + 1 : domain_.num_mdps();
    for (MdpIndex m{first}; m.value() < end; ++m) {
      const auto demo = atlas_.index({m, domain_.initial_state(m)});
      const auto path = atlas_.trajectory(demo);
      std::vector<Cell> seen;
      for (std::size_t t = 0; t < path.actions.size(); ++t) {
        if (!scene_.is_at(m, path.states[t], path.actions[t], happening)) continue;
        const auto cell = domain_.state(m, path.states[t]).robot;
        if (std::find(seen.begin(), seen.end(), cell) != seen.end()) continue;
        seen.push_back(cell);
        auto& place = places[cell];
        if (place.worlds++ == 0) place = {1, demo, t};
      }
    }
    if (places.empty()) {
      reply_.text = first_upper(scene_.name_of(happening)) + " happens nowhere on the way from the map's start.";
      return when_alike_somewhere();
    }
    std::vector<std::pair<Cell, Place>> sorted(places.begin(), places.end());
    std::stable_sort(sorted.begin(), sorted.end(),
                     [](const auto& a, const auto& b) { return a.second.worlds > b.second.worlds; });
    std::vector<std::string> texts;
    for (const auto& [cell, place] : sorted) {
      texts.push_back(cell_text(domain_, cell) +
                      (question_.world ? "" : " in " + worlds_text(place.worlds, domain_.num_mdps())));
    }
    reply_.text =
        first_upper(scene_.name_of(happening)) + " happens at " + listed(texts) + ", counting from the map's start.";
    for (std::size_t i = 0; i < std::min(sorted.size(), kMaxCells); ++i) {
      const auto& [cell, place] = sorted[i];
      show(place.demo,
           "world " + number(atlas_.id(place.demo).mdp) + ", at " + cell_text(domain_, cell) + " with step " +
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
    if (question_.cell) {
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
             question_.instead ? scene_.contrast_to(demo, *question_.instead, true) : scene_.best_deviation(demo));
  }

  // About the path from the map's start.
  void why_path(DemoIndex demo) {
    const auto world = atlas_.id(demo).mdp;
    const auto path = atlas_.trajectory(demo);
    const auto& asked = question_.happening ? *question_.happening : *question_.instead;
    const bool does = scene_.step_of(world, path, asked).has_value();
    const auto what = scene_.name_of(asked) + (does ? " happens" : " does not happen") + " in world " + number(world);
    if (question_.happening && question_.instead && does) {
      return conclude(demo, what, scene_.contrast_to(demo, *question_.instead, true));
    }
    conclude(demo, what, scene_.contrast_to(demo, asked, !does));
  }

  void conclude(DemoIndex demo, const std::string& says, const std::optional<Contrast>& contrast) {
    reply_.text = first_upper(says) + "; " + because(contrast, "no other way is best for anybody") + ".";
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
    const auto contrast = scene_.best_deviation(demo);
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
    reply_.question = "what if: world " + number(base) + " " + changed;
    const auto before = scene_.needed_start(base);
    const auto after = scene_.needed_start(world);
    const auto old_path = atlas_.trajectory(before);
    const auto new_path = atlas_.trajectory(after);
    const auto description = [&](MdpIndex m, const Trajectory& path) {
      return "world " + number(m) + ": " + actions_text(domain_, path.actions);
    };
    if (old_path.actions == new_path.actions) {
      reply_.text = first_upper(changed) + " nothing changes.";
      show(before, description(base, old_path));
      show(after, description(world, new_path));
      return;
    }
    auto contrast =
        best_contrast(atlas_, after, [&](const Contrast& c) { return c.alternative.actions == old_path.actions; });
    if (!contrast) contrast = best_contrast(atlas_, after, [](const Contrast&) { return true; });
    reply_.text = first_upper(changed) + " it does " + counts_text(domain_, atlas_.feature_counts(after)) +
                  " in place of " + counts_text(domain_, atlas_.feature_counts(before)) + "; there " +
                  because(contrast, "no other way is best for anybody") + ".";
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
            "world " + number(base) + " has " + (condition.present ? "" : "no ") + condition.thing + where + " anyway",
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
