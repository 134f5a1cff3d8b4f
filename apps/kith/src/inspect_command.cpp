#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "commands.hpp"
#include "inspect_json.hpp"
#include "kith/core/error.hpp"
#include "kith/domains/domain_file.hpp"
#include "picture.hpp"
#include "words.hpp"

namespace kith::cli {
namespace {

constexpr std::size_t kListLength = 20;  // without --all

// Writes the parts of the human form one after the other.
class Inspection {
 public:
  Inspection(const Atlas& atlas, const InspectOptions& options, const Console& console)
      : atlas_{atlas}, domain_{atlas.domain()}, options_{options}, console_{console} {
    mdp_ = MdpIndex{options.mdp.value_or(domain_.num_mdps() - 1)};
    if (mdp_.value() >= domain_.num_mdps()) {
      throw Error{ErrorKind::kUsage,
                  fmt::format("there is no MDP {}: they are numbered 0 to {}", mdp_.value(), domain_.num_mdps() - 1)};
    }
  }

  std::string text() {
    title();
    if (options_.show.empty()) {
      map();
      reward();
      bec();
      components();
      coverage();
    }
    for (const auto& part : options_.show) show(part);
    return out_;
  }

 private:
  void show(const std::string& part) {
    if (part == "map") map();
    if (part == "policy") policy();
    if (part == "bec") bec();
    if (part == "kc") components();
    if (part == "demos") demos();
    if (part == "tests") tests();
    if (part == "counterfactuals") counterfactuals();
  }

  void heading(const std::string& text) { out_ += "\n" + console_.bold(text) + "\n"; }

  void title() {
    out_ += console_.bold(domain_.id()) + (domain_.title().empty() ? "" : ": " + domain_.title()) + "\n";
    out_ += fmt::format("{} MDPs, {} start states, {} features\n", domain_.num_mdps(), domain_.num_starts(),
                        domain_.num_features());
  }

  void map() {
    heading(fmt::format("Map of MDP {} (robot '@')", mdp_.value()));
    out_ += beside({domain_.draw(mdp_, std::nullopt), start_picture(domain_, {mdp_, domain_.initial_state(mdp_)})}, 2);
  }

  void reward() {
    heading("Reward");
    TextTable table{"llrr"};
    table.add({"  feature", "words", "weight", "at length 1"});
    for (std::size_t k = 0; k < domain_.num_features(); ++k) {
      table.add({"  " + domain_.feature_names()[k], domain_.feature_words(k),
                 fmt::format("{}", domain_.weights().raw[k]),
                 fmt::format("{:.4f}", domain_.weights().unit[static_cast<Eigen::Index>(k)])});
    }
    out_ += table.text(console_);
    for (const auto& half_space : domain_.prior()) out_ += "  known to all: " + described(domain_, half_space) + "\n";
  }

  void constraints(const std::vector<HalfSpace>& half_spaces, const std::string& indent) {
    for (const auto& half_space : half_spaces) out_ += indent + described(domain_, half_space) + "\n";
  }

  void bec() {
    heading("What makes the policy: its behaviour equivalence class");
    constraints(atlas_.policy_bec_half_spaces(), "  ");
    out_ += fmt::format("  solid angle {:.4f} sr of {:.4f} sr\n", atlas_.policy_bec_area_sr(),
                        atlas_.prior_cone().solid_angle());
  }

  void components() {
    heading("Knowledge components, in the order of teaching");
    std::size_t number = 0;
    for (const auto& component : atlas_.knowledge_components()) {
      const auto mdps = std::count(component.uses_mdp.begin(), component.uses_mdp.end(), true);
      out_ += fmt::format("  {}. {} ({} MDPs{}), solid angle {:.4f} sr\n", ++number, component.name, mdps,
                          component.masked ? ", without " + domain_.feature_names()[*component.masked] : "",
                          component.area_sr);
      constraints(atlas_.constraints().half_spaces(component.constraints), "     ");
    }
  }

  void coverage() {
    const auto& coverage = atlas_.coverage();
    heading("What people could expect the robot to do");
    out_ += fmt::format("  {} paths that are best for somebody: {:.2f} per start state, at most {}\n",
                        coverage.vertices, coverage.mean, coverage.max);
    out_ += fmt::format("  {} ways to behave in all of them (policy cells)\n", atlas_.cells().size());
  }

  void policy() {
    heading(fmt::format("The robot's policy in MDP {}", mdp_.value()));
    const auto start = domain_.initial_state(mdp_);
    const auto path = atlas_.trajectory(atlas_.index({mdp_, start}));
    std::vector<GridState> seen;
    for (const auto state : path.states) {
      if (domain_.mdp(mdp_).is_terminal(state)) continue;
      auto now = domain_.state(mdp_, state);
      const auto same = [&](const GridState& other) {
        for (std::size_t i = 0; i < now.items.size(); ++i) {
          if (now.carried[i] != other.carried[i] || (!now.carried[i] && now.items[i] != other.items[i])) return false;
        }
        return now.stations == other.stations;
      };
      if (std::any_of(seen.begin(), seen.end(), same)) continue;
      seen.push_back(now);
      out_ += "  " + configuration(now) + "\n" + beside({policy_picture(atlas_, mdp_, now)}, 4);
    }
    const auto demo = atlas_.index({mdp_, start});
    out_ += "  from the start: " + actions_text(domain_, path.actions) + "\n";
    out_ += fmt::format("  {}, return {:.4f}\n", counts_text(domain_, atlas_.feature_counts(demo)),
                        domain_.weights().return_of(atlas_.feature_counts(demo)));
  }

  [[nodiscard]] std::string configuration(const GridState& state) const {
    std::string text;
    for (std::size_t i = 0; i < state.items.size(); ++i) {
      const auto& name = domain_.item_names()[i];
      text += (text.empty() ? "" : ", ") +
              (state.carried[i] ? "carrying " + name
                                : fmt::format("{} at ({},{})", name, state.items[i].x, state.items[i].y));
    }
    return text + fmt::format("{}{} station{} left", text.empty() ? "" : ", ", state.stations.size(),
                              state.stations.size() == 1 ? "" : "s");
  }

  void demos() {
    const auto first = atlas_.index({mdp_, StateIndex{0}}).value();
    const auto n = domain_.mdp(mdp_).num_states();
    heading(fmt::format("Demonstrations of MDP {}: {}", mdp_.value(), n));
    for (std::size_t i = 0; i < limited(n); ++i) {
      const DemoIndex demo{first + i};
      const auto path = atlas_.trajectory(demo);
      const auto& counts = atlas_.feature_counts(demo);
      out_ += fmt::format("  start {}: {} ({}, return {:.4f}{})\n", i, actions_text(domain_, path.actions),
                          counts_text(domain_, counts), domain_.weights().return_of(counts),
                          atlas_.is_unique(demo) ? "" : ", not the only best path");
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
      out_ += start_and_path(domain_, id, atlas_.trajectory(tests.front()), 4);
    }
  }

  void counterfactuals() {
    const auto demo = atlas_.index({mdp_, domain_.initial_state(mdp_)});
    heading(fmt::format("What people could expect from the start of MDP {}", mdp_.value()));
    out_ += beside({start_picture(domain_, atlas_.id(demo))}, 4);
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
    out_ += fmt::format("  {} ways to behave in all start states (policy cells)\n", atlas_.cells().size());
  }

  [[nodiscard]] std::size_t limited(std::size_t n) const { return options_.all ? n : std::min(n, kListLength); }
  void note_cut(std::size_t n) {
    if (limited(n) < n) out_ += console_.dim(fmt::format("  ... {} more: --all shows them", n - limited(n))) + "\n";
  }

  const Atlas& atlas_;
  const Domain& domain_;
  const InspectOptions& options_;
  const Console& console_;
  MdpIndex mdp_;
  std::string out_;
};

}  // namespace

int run_inspect(const InspectOptions& options, Console& console) {
  const Atlas atlas{load_domain(options.domain)};
  if (console.json()) {
    print_inspection(atlas, options, console);
  } else {
    console.print(Inspection{atlas, options, console}.text());
  }
  return 0;
}

}  // namespace kith::cli
