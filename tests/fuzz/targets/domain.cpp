// Domain files. A domain or errors, never both; of a domain, that states and their pictures correspond, and that it can
// be asked about, taught and judged.

#include <algorithm>

#include "../fuzzing.hpp"
#include "../whole_robot.hpp"
#include "kith/domains/domain_file.hpp"

using namespace kith;

namespace {

void check_states(const Domain& domain, MdpIndex m) {
  const auto& mdp = domain.mdp(m);
  const auto map = domain.map();
  if (!map) return;  // models are a target of their own
  for (std::size_t s = 0; s < std::min<std::size_t>(mdp.num_states(), 8); ++s) {
    const auto picture = map->state(m, StateIndex{s});
    fuzzing::require(map->find_state(m, picture) == StateIndex{s}, "a state is found by its picture");
    const auto drawn = map->draw(m, StateIndex{s});
    fuzzing::require(drawn.size() == static_cast<std::size_t>(map->height()), "a drawing has a line per row");
    for (const auto& row : drawn) {
      fuzzing::require(row.size() == static_cast<std::size_t>(map->width()), "and a character per cell");
    }
  }
  fuzzing::require(domain.initial_state(m).value() < mdp.num_states(), "a robot starts in a state");
  fuzzing::require(!domain.describe_world(m).empty() || domain.present_things(m).empty(),
                   "variants have a description");
}

// What the text may name.
const DomainFiles& files() {
  static const DomainFiles kFiles{
      .known = {
          {"floor.yaml",
           "image: floor.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: "
           "0.196\n"},
          {"floor.pgm", "P2\n4 3\n255\n254 254 254 254\n254 0 205 254\n254 254 254 254\n"},
          {"zones.pgm", "P2\n4 3\n255\n255 255 64 255\n64 255 255 128\n255 255 255 255\n"}}};
  return kFiles;
}

}  // namespace

const fuzzing::Form fuzzing::kForm{.words = "domain"};

fuzzing::Outcome fuzzing::run(std::string_view text) {
  const auto reading = parse_domain(text, "domain.toml", {.max_states = 2'000}, files());
  fuzzing::require(reading.domain.has_value() != has_errors(reading.diagnostics), "a domain, or errors");
  const auto outcome = fuzzing::require_good(reading.diagnostics, text, "domain.toml");
  if (!reading.domain) return outcome;
  const auto& domain = *reading.domain;
  for (const auto& half_space : domain.prior()) {
    fuzzing::require(half_space.contains(domain.weights().integer), "the prior holds at the weights");
  }
  for (std::size_t m = 0; m < std::min<std::size_t>(domain.num_mdps(), 4); ++m) check_states(domain, MdpIndex{m});
  fuzzing::WholeRobot::use(domain);
  return outcome;
}
