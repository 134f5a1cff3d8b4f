#include "curriculum_command.hpp"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "build_facts.hpp"
#include "embedded.hpp"
#include "input.hpp"
#include "kith/bec/memory_needs.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/explain/curriculum.hpp"
#include "kith/explain/curriculum_json.hpp"
#include "kith/explain/legend.hpp"
#include "kith/explain/picture.hpp"
#include "kith/explain/words.hpp"
#include "kith/explain/wrapped.hpp"
#include "page.hpp"
#include "work_notice.hpp"

namespace kith::cli {
namespace {

// The curriculum for a terminal.
class CurriculumText {
 public:
  CurriculumText(const Atlas& atlas, const Curriculum& curriculum, const Console& console)
      : atlas_{atlas}, domain_{atlas.domain()}, curriculum_{curriculum}, console_{console} {}

  std::string text() {
    out_ = console_.bold(domain_.id()) + (domain_.title().empty() ? "" : ": " + domain_.title()) + "\n" +
           legend(domain_, 0);
    if (const auto explained = explained_in_words(domain_); !explained.empty()) line("Note: " + explained + ".", 0);
    if (curriculum_.update) line(curriculum_.update->text, 0);
    for (std::size_t i = 0; i < curriculum_.components.size(); ++i) component(i);
    for (const auto& one : curriculum_.skipped) out_ += "\nNot taught: " + one.name + "; " + one.why + ".\n";
    return out_;
  }

 private:
  void line(const std::string& text, std::size_t indent) {
    const std::string blank(indent, ' ');
    out_ += wrapped(text, kTextWidth, blank, blank) + "\n";
  }

  void component(std::size_t i) {
    const auto& component = curriculum_.components[i];
    out_ += "\n" + console_.bold(fmt::format("{}. {}", i + 1, component.name)) + "\n";
    for (const auto& sentence : all_in_words(domain_, component.constraints)) line("- " + sentence, 3);
    for (std::size_t j = 0; j < component.demonstrations.size(); ++j) demonstration(j, component.demonstrations[j]);
    for (std::size_t j = 0; j < component.tests.size(); ++j) test(j, component.tests[j]);
  }

  void demonstration(std::size_t j, const CurriculumDemonstration& shown) {
    const auto world = atlas_.id(shown.start).mdp;
    const auto& contrast = shown.contrast;
    out_ += fmt::format("\n   Demonstration {}: {}\n", j + 1, world_text(atlas_.domain(), world));
    line(shown.reason, 3);
    out_ += start_and_path(domain_, atlas_.id(shown.start), contrast.robot, 5);
    line("the robot: " + with_chance(world, contrast.robot), 5);
    runs(shown.start, shown.runs);
    if (!first_difference(contrast.robot, contrast.alternative)) {
      line("someone missing this fact would predict the same most likely path, but with other chances", 5);
    } else {
      const auto fork = contrast.robot.states[contrast.decisive];
      line("someone missing this fact would predict: " + with_chance(world, contrast.alternative), 5);
      line(fmt::format("they differ from step {}, {}", contrast.decisive + 1, place(world, fork)), 5);
    }
  }

  // What happened in several runs, and the paths that they took.
  void runs(StartIndex start, const std::vector<PolicyRun>& all) {
    if (all.empty()) return;
    constexpr std::size_t kFew = 3;
    line(runs_in_words(domain_, atlas_.id(start).mdp, all), 5);
    const auto ways = different_ways(all);
    for (std::size_t i = 0; i < std::min(kFew, ways.size()); ++i) {
      const auto& way = ways[i];
      const auto& run = all[way.run];
      line(fmt::format("{} of {}: {}, {}", way.times, all.size(), actions_text(domain_, run.path.actions),
                       run.has_ended ? "ending " + place(atlas_.id(start).mdp, run.path.states.back()) : "and so on"),
           7);
    }
    if (ways.size() > kFew) line(fmt::format("and {}", counted(ways.size() - kFew, "other path")), 7);
  }

  [[nodiscard]] std::string place(MdpIndex world, StateIndex s) const {
    const auto map = domain_.drawing();
    return map ? "at " + cell_text(*map, map->state(world, s).robot)
               : "in state '" + domain_.state_name(world, s) + "'";
  }

  [[nodiscard]] std::string with_chance(MdpIndex world, const Trajectory& path) const {
    const auto chance = chance_in_words(domain_, world, path);
    return actions_text(domain_, world, path) + (chance.empty() ? "" : " (" + chance + ")");
  }

  void test(std::size_t j, const CurriculumTest& test) {
    const auto id = atlas_.id(test.start);
    const auto path = atlas_.trajectory(test.start);
    out_ += fmt::format("\n   Test {}: {}, {} (before it about {:.0f} % would answer correctly)\n", j + 1,
                        world_text(domain_, id.mdp), name_of(test.difficulty), 100.0 * test.share_right);
    out_ += start_and_path(domain_, id, path, 5);
    line("answer: " + with_chance(id.mdp, path), 5);
    runs(test.start, test.runs);
    for (const auto& sentence : all_in_words(domain_, test.covers)) line("shows that " + sentence, 5);
  }

  const Atlas& atlas_;
  const Domain& domain_;
  const Curriculum& curriculum_;
  const Console& console_;
  std::string out_;
};

}  // namespace

int show_curriculum(const CurriculumCommandOptions& options, Console& console) {
  const WorkNotice notice{console, "choosing what to teach about " + options.domain};
  auto domain = load_domain(options.domain);
  require_teaching_memory(domain);
  const Atlas atlas{std::move(domain)};
  CurriculumOptions how;
  how.seed = options.seed;
  if (!options.knowing.empty()) how.teaching.known = known_before(options.knowing, atlas);
  const auto curriculum = make_curriculum(atlas, how);
  if (options.out.empty() && !console.json()) {
    console.print(CurriculumText{atlas, curriculum, console}.text());
    return 0;
  }
  const auto document = curriculum_json(atlas, curriculum, options.seed, program_name());
  if (!options.out.empty())
    write_page("lesson", page_with(for_page(document).dump(-1, ' ', true), detail::kLessonPage), options.out, console);
  if (console.json()) console.print_json(document);
  return 0;
}

}  // namespace kith::cli
