#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "command.hpp"
#include "domain_view.hpp"
#include "kith/bec/comparison.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/explain/expected_ways.hpp"
#include "kith/explain/words.hpp"
#include "kith/present/inspect_json.hpp"
#include "kith/present/inspect_svg.hpp"
#include "kith/present/legend.hpp"
#include "kith/present/picture.hpp"
#include "work_notice.hpp"

namespace kith::cli {
namespace {

struct InspectOptions {
  std::string domain;
  std::vector<std::string> show;   ///< Some of inspect_parts(); empty: the overview.
  std::optional<std::size_t> mdp;  ///< The MDP whose map, policy or demonstrations are shown.
  bool all = false;                ///< No list is cut short.
  std::string svg;                 ///< Folder for pictures; empty: none.
};

constexpr std::size_t kListLength = 20;  // without --all

// Writes the parts of the human form one after the other.
class Inspection {
 public:
  Inspection(const Atlas& atlas, const InspectOptions& options, const Console& console)
      : atlas_{atlas},
        domain_{atlas.domain()},
        options_{options},
        console_{console},
        view_{domain_, options.mdp, options.all, console},
        mdp_{view_.mdp()} {}

  std::string text() {
    out_ += view_.title();
    if (options_.show.empty()) {
      out_ += view_.map() + view_.reward();
      bec();
      components();
      coverage();
    }
    for (const auto& part : options_.show) show(part);
    return out_;
  }

 private:
  void show(const std::string& part) {
    if (part == "map") out_ += view_.map();
    if (part == "policy") out_ += view_.policy();
    if (part == "bec") bec();
    if (part == "kc") components();
    if (part == "demos") demos();
    if (part == "tests") tests();
    if (part == "counterfactuals") counterfactuals();
  }

  void heading(const std::string& text) { out_ += "\n" + console_.bold(text) + "\n"; }

  void constraints(const std::vector<HalfSpace>& half_spaces, const std::string& indent) {
    for (const auto& half_space : half_spaces) out_ += indent + described(domain_, half_space) + "\n";
  }

  void bec() {
    heading("What determines the policy: its behaviour equivalence class");
    constraints(atlas_.policy_bec_half_spaces(), "  ");
    out_ += fmt::format("  {}; the prior has {}\n", area_text(atlas_.policy_bec_area()),
                        area_text(atlas_.prior_cone().measure()));
    if (const auto left = atlas_.regret_left()) {
      out_ += fmt::format(
          "  an estimate, as the robot's paths from these starts do not meet every state: people within it keep\n"
          "  {:.2g} % of the regret that people have before any lesson\n",
          100.0 * *left);
    }
  }

  void components() {
    heading("Knowledge components, in the order of teaching");
    std::size_t number = 0;
    for (const auto& component : atlas_.knowledge_components()) {
      const auto mdps = std::count(component.uses_mdp.begin(), component.uses_mdp.end(), true);
      out_ += fmt::format("  {}. {} ({} MDPs{}), {}\n", ++number, component.name, mdps,
                          component.masked.empty() ? "" : ", without " + masked_names(domain_, component),
                          area_text({component.area_sr, component.area_error}));
      constraints(atlas_.constraints().half_spaces(component.constraints), "     ");
    }
  }

  // "solid angle 0.0261 sr"; elsewhere than in space the share of the sphere, with its standard error if it has one.
  [[nodiscard]] std::string area_text(const SolidAngle& area) const {
    const auto d = domain_.num_features();
    if (d == 3) return fmt::format("{:.4f} sr of the sphere", area.value);
    const double whole = sphere_area(d);
    auto text = fmt::format("{:.3g} % of the sphere", 100.0 * area.value / whole);
    if (area.standard_error > 0.0)
      text += fmt::format(" (standard error {:.1g} %)", 100.0 * area.standard_error / whole);
    return text;
  }

  void coverage() {
    if (!atlas_.is_tabulated()) {
      heading("What people could expect the robot to do");
      out_ += "  computed on demand; not precomputed for this domain\n";
      return;
    }
    const auto& coverage = atlas_.coverage();
    heading("What people could expect the robot to do");
    out_ += fmt::format("  {} paths that are optimal for some weights: {:.2f} per start state, at most {}\n",
                        coverage.vertices, coverage.mean, coverage.max);
    out_ += fmt::format("  {} different behaviours over all start states (policy cells)\n", atlas_.cells().size());
  }

  void demos() {
    const auto& starts = domain_.starts(mdp_);
    const auto n = starts.size();
    heading(fmt::format("Demonstrations of MDP {}: {}", mdp_.value(), n));
    for (std::size_t i = 0; i < limited(n); ++i) {
      const auto demo = atlas_.index({mdp_, starts[i]});
      const auto path = atlas_.trajectory(demo);
      const auto& counts = atlas_.feature_counts(demo);
      out_ += fmt::format("  start {}: {} ({}, return {:.4f}{})\n", starts[i].value(),
                          actions_text(domain_, mdp_, path), counts_text(domain_, counts), return_of(domain_, counts),
                          atlas_.is_unique(demo) ? "" : ", one of several best paths");
      out_ += start_and_path(domain_, atlas_.id(demo), path, 4);
      constraints(atlas_.constraints().half_spaces(atlas_.one_step(demo)), "    ");
    }
    note_cut(n);
  }

  void tests() {
    heading("What can test each constraint of the policy");
    for (const auto& half_space : atlas_.policy_bec_half_spaces()) {
      const auto c = atlas_.constraints().find(half_space);
      const auto tests = c ? atlas_.tests_for(*c) : std::span<const DemoIndex>{};
      out_ += "  " + described(domain_, half_space) + fmt::format(": {} start states\n", tests.size());
      if (tests.empty()) continue;
      const auto id = atlas_.id(tests.front());
      out_ += fmt::format("    for instance MDP {}, start {}\n", id.mdp.value(), id.start.value());
      const auto path = atlas_.trajectory(tests.front());
      out_ += start_and_path(domain_, id, path, 4);
      if (path.repeats_from) out_ += "    and so on: " + never_in_words(domain_, id.mdp, path) + "\n";
    }
  }

  void counterfactuals() {
    const auto demo = atlas_.index({mdp_, domain_.initial_state(mdp_)});
    heading(fmt::format("What people could expect from the start of MDP {}", mdp_.value()));
    if (const auto map = domain_.drawing()) {
      out_ += beside({bare_picture(*map, atlas_.id(demo)), start_picture(*map, atlas_.id(demo))}, 4);
    } else {
      out_ += "    " + domain_.state_name(mdp_, domain_.initial_state(mdp_)) + "\n";
    }
    if (!atlas_.is_tabulated()) return expected_by_a_sample(demo);
    const auto& robot = atlas_.feature_counts(demo);
    const auto paths = atlas_.coverage_set(demo);
    for (std::size_t i = 0; i < limited(paths.size()); ++i) {
      if (paths[i] == robot) {
        out_ += "  " + counts_text(domain_, paths[i]) + ": the robot's own path\n";
        continue;
      }
      out_ += "  " + counts_text(domain_, paths[i]) + ": shows them that " +
              in_words(domain_, HalfSpace{robot - paths[i]}) + "\n";
    }
    note_cut(paths.size());
    out_ += fmt::format("  {} different behaviours over all start states (policy cells)\n", atlas_.cells().size());
  }

  void expected_by_a_sample(DemoIndex demo) {
    Behaviours behaviours{atlas_};
    const auto ways = expected_ways(behaviours, demo);
    out_ += "  by people whose weights fill the prior evenly\n";
    for (std::size_t i = 0; i < limited(ways.size()); ++i) {
      const auto& way = ways[i];
      out_ += fmt::format("  {:3.0f} %  {}: ", 100.0 * way.share, counts_text(domain_, way.counts));
      const auto told = preference_of_robot(domain_, atlas_.feature_counts(demo) - way.counts);
      if (way.counts == atlas_.feature_counts(demo)) {
        out_ += "the robot's own path\n";
      } else {
        out_ += told ? "shows them " + described(domain_, *told) + "\n" : "just as good\n";
      }
      const auto path = behaviours.trajectory(demo, way.weights);
      if (path && path->repeats_from) out_ += "         " + actions_text(domain_, mdp_, *path) + "\n";
    }
    note_cut(ways.size());
  }

  [[nodiscard]] std::size_t limited(std::size_t n) const { return options_.all ? n : std::min(n, kListLength); }
  void note_cut(std::size_t n) {
    if (limited(n) < n) out_ += console_.dim(fmt::format("  ... {} more: --all shows them", n - limited(n))) + "\n";
  }

  const Atlas& atlas_;
  const Domain& domain_;
  const InspectOptions& options_;
  const Console& console_;
  DomainView view_;
  MdpIndex mdp_;
  std::string out_;
};

void write_svg(const InspectOptions& options, const std::vector<SvgFile>& files, Console& console) {
  write_pictures(options.svg, files);
  std::vector<std::string> names;
  for (const auto& file : files) names.push_back(file.name);
  console.info(fmt::format("{} in {}", listed(names), options.svg));
}

// With a single feature there is nothing to teach, but still something to see.
int inspect_without_atlas(const Domain& domain, const InspectOptions& options, Console& console) {
  const DomainView view{domain, options.mdp, options.all, console};
  if (!options.svg.empty()) write_svg(options, domain_pictures(domain, view.mdp()), console);
  if (console.json()) {
    console.print_json(inspection_json(domain));
  } else {
    std::string text = view.title();
    const auto& show = options.show;
    const auto asked = [&](const char* part) { return std::find(show.begin(), show.end(), part) != show.end(); };
    if (show.empty() || asked("map")) text += view.map();
    if (show.empty()) text += view.reward();
    if (show.empty() || asked("policy")) text += view.policy();
    console.print(text);
  }
  console.warning("what can be taught is not shown: with a single feature there is nothing to weigh");
  return 0;
}

void declare(OptionList& list, InspectOptions& options) {
  list.domain(options.domain).required();
  list.words("--show", options.show, "PARTS", {"map", "policy", "bec", "kc", "demos", "tests", "counterfactuals"},
             "What to show, separated by commas");
  list.integer("--mdp", options.mdp, {}, "Number of the MDP to show (default: the last, with everything)");
  list.flag("--all", options.all, "Do not shorten long lists");
  list.text("--svg", options.svg, "DIR", "Write pictures to this folder: map, policy, region, coverage");
  list.json();
}

int run(const InspectOptions& options, Console& console) {
  const WorkNotice notice{console, "planning " + options.domain};
  auto domain = load_domain(options.domain);
  if (domain.num_features() < 2) return inspect_without_atlas(domain, options, console);
  const Atlas atlas{std::move(domain)};
  const auto mdp = DomainView{atlas.domain(), options.mdp, options.all, console}.mdp();
  if (!options.svg.empty()) {
    auto files = domain_pictures(atlas.domain(), mdp);
    for (auto& file : atlas_pictures(atlas, mdp)) files.push_back(std::move(file));
    write_svg(options, files, console);
  }
  if (console.json()) {
    const bool demos = std::find(options.show.begin(), options.show.end(), "demos") != options.show.end();
    console.print_json(inspection_json(atlas, {demos, options.mdp}));
  } else {
    console.print(Inspection{atlas, options, console}.text());
  }
  return 0;
}

}  // namespace

void add_inspect(Commands& commands) {
  commands.add<InspectOptions>(
      "inspect", "Show a domain: map, reward, policy, and what can be taught",
      {"kith inspect item-delivery", "kith inspect item-delivery --show policy,demos --mdp 63"}, declare, run);
}

}  // namespace kith::cli
