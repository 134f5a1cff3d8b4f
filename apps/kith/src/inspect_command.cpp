#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>

#include "command.hpp"
#include "input.hpp"
#include "kith/bec/comparison.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/explain/bracket.hpp"
#include "kith/explain/expected_ways.hpp"
#include "kith/explain/inspect_json.hpp"
#include "kith/explain/inspect_svg.hpp"
#include "kith/explain/legend.hpp"
#include "kith/explain/picture.hpp"
#include "kith/explain/target.hpp"
#include "kith/explain/words.hpp"
#include "kith/mdp/behaviour.hpp"
#include "kith/mdp/planner.hpp"
#include "planning_input.hpp"
#include "work_notice.hpp"

namespace kith::cli {
namespace {

struct InspectOptions {
  std::string domain;
  std::vector<std::string> show;  ///< Some of inspect_parts(); empty: the overview.
  std::string mdp;                ///< The MDP whose map, policy or demonstrations are shown: number or name.
  bool all = false;               ///< No list is cut short.
  std::string svg;                ///< Folder for pictures; empty: none.
};

constexpr std::size_t kListLength = 20;  // without --all

// Writes the parts of the human form one after the other. With a single feature there is no atlas, as there is nothing
// to teach, but still something to see.
class Inspection {
 public:
  Inspection(const Domain& domain, const std::string& name, const Atlas* atlas, MdpIndex mdp, bool all,
             const Console& console)
      : domain_{domain}, name_{name}, atlas_{atlas}, mdp_{mdp}, all_{all}, console_{console} {}

  std::string text(const std::vector<std::string>& parts) {
    out_ += title();
    if (parts.empty()) {
      out_ += map() + reward();
      if (atlas_ == nullptr) {
        out_ += policy();
      } else {
        bec();
        what_matters();
        components();
        coverage();
        what_works();
      }
    }
    for (const auto& part : parts) show(part);
    return out_;
  }

 private:
  void show(const std::string& part) {
    if (part == "map") out_ += map();
    if (part == "policy") out_ += policy();
    if (atlas_ == nullptr) return;
    if (part == "bec") bec();
    if (part == "kc") components();
    if (part == "demos") demos();
    if (part == "tests") tests();
    if (part == "times") times();
    if (part == "counterfactuals") counterfactuals();
  }

  [[nodiscard]] std::string heading_text(const std::string& text) const { return "\n" + console_.bold(text) + "\n"; }
  void heading(const std::string& text) { out_ += heading_text(text); }

  [[nodiscard]] std::string title() const {
    return console_.bold(domain_.id()) + (domain_.title().empty() ? "" : ": " + domain_.title()) + "\n" +
           fmt::format("{}, {}, {}\n", counted(domain_.num_mdps(), "world"),
                       counted(domain_.num_starts(), "start state"), counted(domain_.num_features(), "feature"));
  }

  // With the legend of the symbols; without a map the size of the model.
  [[nodiscard]] std::string map() const {
    const auto map = domain_.drawing();
    if (!map) return model();
    const StartId start{mdp_, domain_.initial_state(mdp_)};
    return (map->is_picture() ? model() : "") +
           heading_text(fmt::format("Map of {}, and its first start", world_text(domain_, mdp_))) +
           beside({bare_picture(*map, start), start_picture(*map, start)}, 2) + "\n" + legend(domain_, 2);
  }

  // What there is instead of a map.
  [[nodiscard]] std::string model() const {
    const auto& mdp = domain_.mdp(mdp_);
    const auto name = domain_.describe_world(mdp_);
    auto text = heading_text(fmt::format("Model of world {}{}", mdp_.value(), name.empty() ? "" : ": " + name)) +
                fmt::format("  {} and {}, {}, {}\n", counted(mdp.num_states(), "state"),
                            counted(mdp.num_terminals(), "terminal one"), counted(mdp.num_actions(), "action"),
                            mdp.is_deterministic() ? "outcomes are certain" : "outcomes are uncertain") +
                fmt::format("  discount {}\n  the robot enters at: {}\n", mdp.discount(),
                            domain_.state_name(mdp_, domain_.initial_state(mdp_)));
    for (std::size_t t = 0; t < std::min(mdp.num_terminals(), kListLength); ++t) {
      text += "  an end: " + domain_.state_name(mdp_, StateIndex{mdp.num_states() + t}) + "\n";
    }
    return text;
  }

  // What there is instead of arrows.
  [[nodiscard]] std::string policy_table() const {
    const auto& mdp = domain_.mdp(mdp_);
    const auto behaviour = behave(mdp, domain_.weights().raw, {.scale = domain_.count_scale()});
    if (!behaviour) return "  there is none with a finite return\n";
    TextTable table{"llr"};
    table.add({"  state", "action", "value"});
    const auto shown = all_ ? mdp.num_states() : std::min(mdp.num_states(), kListLength);
    for (std::size_t s = 0; s < shown; ++s) {
      const auto& choice = mdp.choices(StateIndex{s})[behaviour->choice[s]];
      table.add({"  " + domain_.state_name(mdp_, StateIndex{s}), domain_.action_names()[choice.action.value()],
                 fmt::format("{:.4f}", behaviour->values[s])});
    }
    auto text = table.text(console_);
    if (shown < mdp.num_states()) text += fmt::format("  ... {} more: --all shows them\n", mdp.num_states() - shown);
    return text + "  values are with the weights as written\n";
  }

  // Raw and at length 1.
  [[nodiscard]] std::string reward() const {
    TextTable table{"llrr"};
    table.add({"  feature", "words", "weight", "at length 1"});
    for (std::size_t k = 0; k < domain_.num_features(); ++k) {
      IntegerVector once(domain_.num_features());
      once[k] = 1;
      table.add({"  " + domain_.feature_names()[k], domain_.feature_words(k),
                 fmt::format("{}", domain_.weights().raw[k]),
                 fmt::format("{:.4f}", domain_.weights().return_of(once))});
    }
    auto text = heading_text("Reward") + table.text(console_);
    if (const auto explained = explained_in_words(domain_); !explained.empty()) text += "  " + explained + "\n";
    for (const auto& half_space : domain_.prior()) text += "  known to all: " + described(domain_, half_space) + "\n";
    return text;
  }

  // For every configuration on the way from the start, or as a table.
  [[nodiscard]] std::string policy() const {
    auto text = heading_text(fmt::format("The robot's policy in {}", world_text(domain_, mdp_)));
    const auto& mdp = domain_.mdp(mdp_);
    const auto map = domain_.drawing();
    if (!map) return text + policy_table();
    const auto policy = policy_to_draw(domain_, mdp_);
    if (!policy) return text + policy_table();
    const auto start = domain_.initial_state(mdp_);
    const auto& path = policy->path;
    for (const auto& now : configurations_on(domain_, *map, mdp_, path)) {
      text += "  " + configuration_in_words(*map, mdp_, now) + "\n" +
              beside({policy_picture(domain_, *map, mdp_, policy->choice, now)}, 4);
    }
    text += "  ^ v < > move the robot; a letter begins the name of another action\n";
    if (mdp.is_deterministic() && mdp.discount() < 1.0)
      text += "  from the start: " + actions_text(domain_, mdp_, path) + "\n";
    if (!kith::is_exact(mdp)) return text + policy_table();
    const auto counts = plan_exactly(mdp, domain_.weights().integer).solution.value().feature_counts[start.value()];
    return text + "  from the start: " + actions_text(domain_, path.actions) + "\n" +
           fmt::format("  {}, return {:.4f}\n", counts_text(domain_, counts), domain_.weights().return_of(counts));
  }

  void constraints(const std::vector<HalfSpace>& half_spaces, const std::string& indent) {
    for (const auto& half_space : half_spaces) {
      const auto words = in_words(domain_, half_space, half_spaces);
      out_ += indent + normal_text(domain_, half_space) + (words.empty() ? "" : ": " + words) + "\n";
    }
  }

  void bec() {
    heading("What determines the policy: its behaviour equivalence class");
    constraints(atlas_->policy_bec_half_spaces(), "  ");
    out_ += fmt::format("  {}; the prior has {}\n", area_text(atlas_->policy_bec_area()),
                        area_text(atlas_->prior_cone().measure()));
    if (const auto left = atlas_->regret_left()) {
      out_ += fmt::format(
          "  an estimate, as the robot's paths from these starts do not meet every state: people within it keep\n"
          "  {:.2g} % of the regret that people have before any lesson\n",
          100.0 * *left);
    }
  }

  // How far every weight may change before the robot does anything else anywhere.
  void what_matters() {
    heading(fmt::format("What matters: as long as the other weights stay, it does {} in every world if",
                        leaves_out_ties(*atlas_) ? "as well (some paths are equally good)" : "the same"));
    const auto reference = reference_feature(domain_, atlas_->knowledge_components());
    const auto& unit = domain_.wording(reference).one;
    for (std::size_t k = 0; k < domain_.num_features(); ++k) {
      if (k == reference) continue;
      const auto same = while_others_stay(domain_, atlas_->policy_bec_half_spaces(), k, reference);
      if (same.low || same.high) {
        const auto size = domain_.weights().integer[reference];
        const Ratio own{domain_.weights().integer[k], std::abs(size)};
        const auto range = !same.high  ? fmt::format("{:.4g} or more", same.low->value())
                           : !same.low ? fmt::format("{:.4g} or less", same.high->value())
                                       : fmt::format("{:.4g} to {:.4g}", same.low->value(), same.high->value());
        out_ += fmt::format("  {} weighs {:.4g}, where {} weighs {}: {}\n", domain_.wording(k).one, own.value(), unit,
                            size < 0 ? -1 : 1, range);
      } else {
        out_ += "  " + domain_.wording(k).one + " has any weight: no world tests it, and nothing about it is taught\n";
      }
    }
  }

  // How long things take with this robot on this machine, by doing some of them.
  void times() {
    heading("How long things take with this robot here");
    auto spec = study_of("paper", {}).study->variants.front();
    spec.domain = domain_.id();
    take_domain(spec, domain_);
    spec.strategies = {strategy_named("common")};
    spec.compositions = {"NNP"};
    constexpr std::size_t kTeams = 300;
    out_ += fmt::format("  {} of two novices and a proficient learner, strategy common\n",
                        work_text(try_cells(*atlas_, spec, 0), kTeams));
    out_ += "  kith fit and power say how long they take before they begin\n";
  }

  // Said here, not in the eighth hour.
  void what_works() {
    heading("What works with this robot");
    out_ += "  lessons, questions, studies and live sessions\n";
    const bool has_tables = atlas_->find_tables() != nullptr;
    const bool is_solid = domain_.num_features() == 3;
    if (has_tables && is_solid) {
      out_ += "  kith fit and kith audit, and beliefs drawn on a sphere\n";
    } else {
      out_ += "  kith audit; kith fit, which tells answers apart by paths that it samples and says how noisy that is\n";
    }
    if (!is_solid) out_ += "  beliefs and regions are drawn for pairs of features, areas are estimates\n";
    out_ += fmt::format("  kith inspect {} --show times measures how long a study takes here\n", name_);
  }

  void components() {
    heading("Knowledge components, in the order of teaching");
    std::size_t number = 0;
    for (const auto& component : atlas_->knowledge_components()) {
      const auto mdps = std::count(component.uses_mdp.begin(), component.uses_mdp.end(), true);
      out_ += fmt::format("  {}. {} ({}{}), {}\n", ++number, component.name,
                          counted(static_cast<std::size_t>(mdps), "world"),
                          component.masked.empty() ? "" : ", without " + masked_names(domain_, component),
                          area_text({component.area_sr, component.area_error}));
      constraints(atlas_->constraints().half_spaces(component.constraints), "     ");
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
    heading("What people could expect the robot to do");
    const auto* tables = atlas_->find_tables();
    if (tables == nullptr) {
      out_ += "  computed on demand; not precomputed for this domain\n";
      return;
    }
    const auto& coverage = tables->coverage();
    out_ += fmt::format("  {} paths that are optimal for some weights: {:.2f} per start state, at most {}\n",
                        coverage.vertices, coverage.mean, coverage.max);
    out_ += fmt::format("  {} different behaviours over all start states (policy cells)\n", tables->cells().size());
  }

  void demos() {
    const auto& starts = domain_.starts(mdp_);
    const auto n = starts.size();
    heading(fmt::format("Demonstrations of {}: {}", world_text(domain_, mdp_), n));
    for (std::size_t i = 0; i < limited(n); ++i) {
      const auto start_index = atlas_->index({mdp_, starts[i]});
      const auto path = atlas_->trajectory(start_index);
      const auto& counts = atlas_->feature_counts(start_index);
      out_ += fmt::format("  start {}: {} ({}, return {:.4f}{})\n", starts[i].value(),
                          actions_text(domain_, mdp_, path), counts_text(domain_, counts), return_of(domain_, counts),
                          atlas_->is_unique(start_index) ? "" : ", one of several best paths");
      out_ += start_and_path(domain_, atlas_->id(start_index), path, 4);
      constraints(atlas_->constraints().half_spaces(atlas_->one_step(start_index)), "    ");
    }
    note_cut(n);
  }

  void tests() {
    heading("What can test each constraint of the policy");
    for (const auto& half_space : atlas_->policy_bec_half_spaces()) {
      const auto c = atlas_->constraints().find(half_space);
      const auto tests = c ? atlas_->tests_for(*c) : std::span<const StartIndex>{};
      out_ += "  " + described(domain_, half_space) + fmt::format(": {} start states\n", tests.size());
      if (tests.empty()) continue;
      const auto id = atlas_->id(tests.front());
      out_ += fmt::format("    for instance {}, start {}\n", world_text(domain_, id.mdp), id.start.value());
      const auto path = atlas_->trajectory(tests.front());
      out_ += start_and_path(domain_, id, path, 4);
      if (path.repeats_from) out_ += "    and so on: " + never_in_words(domain_, id.mdp, path) + "\n";
    }
  }

  void counterfactuals() {
    const auto start_index = atlas_->index({mdp_, domain_.initial_state(mdp_)});
    heading(fmt::format("What people could expect from the start of {}", world_text(domain_, mdp_)));
    if (const auto map = domain_.drawing()) {
      out_ += beside({bare_picture(*map, atlas_->id(start_index)), start_picture(*map, atlas_->id(start_index))}, 4);
    } else {
      out_ += "    " + domain_.state_name(mdp_, domain_.initial_state(mdp_)) + "\n";
    }
    const auto* tables = atlas_->find_tables();
    if (tables == nullptr) return expected_by_a_sample(start_index);
    const auto& robot = atlas_->feature_counts(start_index);
    const auto paths = tables->coverage_set(start_index);
    for (std::size_t i = 0; i < limited(paths.size()); ++i) {
      if (paths[i] == robot) {
        out_ += "  " + counts_text(domain_, paths[i]) + ": the robot's own path\n";
        continue;
      }
      out_ += "  " + counts_text(domain_, paths[i]) + ": shows them that " +
              in_words(domain_, HalfSpace{robot - paths[i]}) + "\n";
    }
    note_cut(paths.size());
    out_ += fmt::format("  {} different behaviours over all start states (policy cells)\n", tables->cells().size());
  }

  void expected_by_a_sample(StartIndex start_index) {
    Behaviours behaviours{*atlas_};
    const auto ways = expected_ways(behaviours, start_index);
    out_ += "  by people whose weights fill the prior evenly\n";
    for (std::size_t i = 0; i < limited(ways.size()); ++i) {
      const auto& way = ways[i];
      out_ += fmt::format("  {:3.0f} %  {}: ", 100.0 * way.share, counts_text(domain_, way.counts));
      const auto told = preference_of_robot(domain_, atlas_->feature_counts(start_index) - way.counts);
      if (way.counts == atlas_->feature_counts(start_index)) {
        out_ += "the robot's own path\n";
      } else {
        out_ += told ? "shows them " + described(domain_, *told) + "\n" : "just as good\n";
      }
      const auto path = behaviours.trajectory(start_index, way.weights);
      if (path && path->repeats_from) out_ += "         " + actions_text(domain_, mdp_, *path) + "\n";
    }
    note_cut(ways.size());
  }

  [[nodiscard]] std::size_t limited(std::size_t n) const { return all_ ? n : std::min(n, kListLength); }
  void note_cut(std::size_t n) {
    if (limited(n) < n) out_ += console_.dim(fmt::format("  ... {} more: --all shows them", n - limited(n))) + "\n";
  }

  const Domain& domain_;
  const std::string& name_;
  const Atlas* atlas_;
  MdpIndex mdp_;
  bool all_;
  const Console& console_;
  std::string out_;
};

void declare(OptionList& list, InspectOptions& options) {
  list.domain(options.domain).required();
  list.words("--show", options.show, "PARTS",
             {"map", "policy", "bec", "kc", "demos", "tests", "counterfactuals", "times"},
             "What to show, separated by commas");
  list.text("--mdp", options.mdp, "MDP", "Number or name of the world to show (default: the last, with everything)");
  list.flag("--all", options.all, "Do not shorten long lists");
  list.text("--svg", options.svg, "DIR", "Write pictures to this folder: map, policy, region, coverage");
  list.json();
}

int run(const InspectOptions& options, Console& console) {
  const WorkNotice notice{console, "planning " + options.domain};
  const auto domain = load_domain(options.domain);
  const auto mdp = options.mdp.empty() ? MdpIndex{domain.num_mdps() - 1} : mdp_called(domain, options.mdp);
  std::optional<const Atlas> atlas;
  if (domain.num_features() > 1) atlas.emplace(domain);
  if (!options.svg.empty()) {
    auto files = domain_pictures(domain, mdp);
    if (atlas) {
      for (auto& file : atlas_pictures(*atlas, mdp)) files.push_back(std::move(file));
    }
    write_pictures(options.svg, files);
    std::vector<std::string> names;
    for (const auto& file : files) names.push_back(file.name);
    console.info(fmt::format("{} in {}", listed(names), options.svg));
  }
  const bool demos = std::find(options.show.begin(), options.show.end(), "demos") != options.show.end();
  console.print(
      [&] {
        return atlas ? inspection_json(*atlas, {demos, options.mdp.empty() ? std::nullopt : std::optional{mdp.value()}})
                     : inspection_json(domain);
      },
      [&] {
        return Inspection{domain, options.domain, atlas ? &*atlas : nullptr, mdp, options.all, console}.text(
            options.show);
      });
  if (!atlas) console.warning("what can be taught is not shown: with a single feature there is nothing to weigh");
  return 0;
}

}  // namespace

void add_inspect(Commands& commands) {
  commands.add<InspectOptions>(
      "inspect", "Show a domain: map, reward, policy, and what can be taught",
      {"kith inspect item-delivery", "kith inspect item-delivery --show policy,demos --mdp 63"}, declare, run);
}

}  // namespace kith::cli
