#include "kith/bec/transfer.hpp"

#include <algorithm>

namespace kith {
namespace {

// The number of an action among the choices of a state.
std::optional<std::size_t> choice_of(std::span<const Choice> choices, ActionIndex action) {
  const auto found = std::find_if(choices.begin(), choices.end(), [&](const Choice& c) { return c.action == action; });
  if (found == choices.end()) return std::nullopt;
  return static_cast<std::size_t>(found - choices.begin());
}

}  // namespace

std::optional<Transfer> transferred(const Atlas& atlas, StartIndex demonstration, StartIndex test) {
  const auto id = atlas.id(test);
  const auto& mdp = atlas.domain().mdp(id.mdp);
  if (!atlas.find_tables()) {
    const auto choice = choice_of(mdp.choices(id.start), atlas.action(demonstration));
    if (!choice) return std::nullopt;
    return Transfer{atlas.deviation_counts(test, *choice), std::nullopt};
  }
  Transfer transfer{IntegerVector(atlas.domain().num_features()), std::nullopt};
  auto state = id.start;
  for (const auto at : atlas.path(demonstration)) {
    const auto choices = mdp.choices(state);
    const auto choice = choice_of(choices, atlas.action(at));
    if (!choice) continue;
    const auto& outcome = mdp.outcomes(choices[*choice]).front();
    transfer.counts += mdp.integer_features(outcome);
    state = outcome.next;
    if (mdp.is_terminal(state)) return transfer;
  }
  transfer.rest = atlas.index({id.mdp, state});
  return transfer;
}

}  // namespace kith
