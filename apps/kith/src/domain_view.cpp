#include "domain_view.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "kith/core/error.hpp"
#include "kith/explain/words.hpp"
#include "kith/mdp/behaviour.hpp"
#include "kith/mdp/planner.hpp"
#include "kith/present/legend.hpp"
#include "kith/present/picture.hpp"

namespace kith::cli {
namespace {

constexpr std::size_t kListed = 20;  // without --all

}  // namespace

DomainView::DomainView(const Domain& domain, std::optional<std::size_t> mdp, bool all, const Console& console)
    : domain_{domain}, console_{console}, all_{all}, mdp_{mdp.value_or(domain.num_mdps() - 1)} {
  if (mdp_.value() < domain.num_mdps()) return;
  throw Error{ErrorKind::kUsage,
              fmt::format("there is no MDP {}: they are numbered 0 to {}", mdp_.value(), domain.num_mdps() - 1)};
}

std::string DomainView::title() const {
  return console_.bold(domain_.id()) + (domain_.title().empty() ? "" : ": " + domain_.title()) + "\n" +
         fmt::format("{}, {}, {}\n", counted(domain_.num_mdps(), "MDP"), counted(domain_.num_starts(), "start state"),
                     counted(domain_.num_features(), "feature"));
}

std::string DomainView::map() const {
  const auto map = domain_.drawing();
  if (!map) return model();
  const DemoId start{mdp_, domain_.initial_state(mdp_)};
  return (map->is_picture() ? model() : "") + heading(fmt::format("Map of MDP {}, and its first start", mdp_.value())) +
         beside({bare_picture(*map, start), start_picture(*map, start)}, 2) + "\n" + legend(domain_, 2);
}

std::string DomainView::model() const {
  const auto& mdp = domain_.mdp(mdp_);
  const auto name = domain_.describe_variant(mdp_);
  auto text = heading(fmt::format("Model of MDP {}{}", mdp_.value(), name.empty() ? "" : ": " + name)) +
              fmt::format("  {} and {}, {}, {}\n", counted(mdp.num_states(), "state"),
                          counted(mdp.num_terminals(), "terminal one"), counted(mdp.num_actions(), "action"),
                          mdp.is_deterministic() ? "outcomes are certain" : "outcomes are uncertain") +
              fmt::format("  discount {}\n  the robot enters at: {}\n", mdp.discount(),
                          domain_.state_name(mdp_, domain_.initial_state(mdp_)));
  for (std::size_t t = 0; t < std::min(mdp.num_terminals(), kListed); ++t) {
    text += "  an end: " + domain_.state_name(mdp_, StateIndex{mdp.num_states() + t}) + "\n";
  }
  return text;
}

std::string DomainView::policy_table() const {
  const auto& mdp = domain_.mdp(mdp_);
  const auto behaviour = behave(mdp, domain_.weights().raw, {.scale = domain_.count_scale()});
  if (!behaviour) return "  there is none with a finite return\n";
  TextTable table{"llr"};
  table.add({"  state", "action", "value"});
  const auto shown = all_ ? mdp.num_states() : std::min(mdp.num_states(), kListed);
  for (std::size_t s = 0; s < shown; ++s) {
    const auto& choice = mdp.choices(StateIndex{s})[behaviour->choice[s]];
    table.add({"  " + domain_.state_name(mdp_, StateIndex{s}), domain_.action_names()[choice.action.value()],
               fmt::format("{:.4f}", behaviour->values[s])});
  }
  auto text = table.text(console_);
  if (shown < mdp.num_states()) text += fmt::format("  ... {} more: --all shows them\n", mdp.num_states() - shown);
  return text + "  values are with the weights as written\n";
}

std::string DomainView::reward() const {
  TextTable table{"llrr"};
  table.add({"  feature", "words", "weight", "at length 1"});
  for (std::size_t k = 0; k < domain_.num_features(); ++k) {
    IntegerVector once(domain_.num_features());
    once[k] = 1;
    table.add({"  " + domain_.feature_names()[k], domain_.feature_words(k), fmt::format("{}", domain_.weights().raw[k]),
               fmt::format("{:.4f}", domain_.weights().return_of(once))});
  }
  auto text = heading("Reward") + table.text(console_);
  for (const auto& half_space : domain_.prior()) text += "  known to all: " + described(domain_, half_space) + "\n";
  return text;
}

std::string DomainView::policy() const {
  auto text = heading(fmt::format("The robot's policy in MDP {}", mdp_.value()));
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

}  // namespace kith::cli
