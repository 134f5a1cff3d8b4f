// Policies. The first byte says of which domain. A policy or errors, never both; what is read
// has a probability for every choice, written down again it reads as the same, and weights that are inferred from it
// make a domain file that is read.

#include <cmath>

#include "../fuzzing.hpp"
#include "kith/bec/inference.hpp"
#include "kith/core/error.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/domains/policy_file.hpp"
#include "kith/domains/variation.hpp"

using namespace kith;

namespace {

constexpr const char* kFile = "policy";

struct Robot {
  std::string text;
  DomainFiles files;
  Domain domain;
};

Robot robot(std::string text, const DomainFiles& files) {
  auto reading = parse_unweighed_domain(text, "domain.toml", files);
  return {std::move(text), files, reading.domain.value()};
}

// With chance and a discount; a map of two worlds.
const Robot& robot_of(unsigned char first) {
  static const Robot kModel = robot(
      "schema = \"kith.domain/1\"\nid = \"m\"\n[mdp]\ndiscount = 0.5\nactions = [\"on\", \"back\"]\n[model]\n"
      "format = \"csv\"\nstates = \"s.csv\"\ntransitions = \"t.csv\"\n[[feature]]\nname = \"mud\"\n[[feature]]\n"
      "name = \"step\"\n[prior]\nhalfspaces = [ { step = -1 } ]\n",
      {{},
       {{"s.csv", "state,terminal\n0,false\n1,false\n2,false\n3,true\n"},
        {"t.csv",
         "state,action,next,probability,mud,step\n0,on,1,1,0,1\n0,back,0,1,0,1\n1,on,2,0.5,1,1\n1,on,0,0.5,0,1\n"
         "1,back,0,1,0,1\n2,on,3,1,0,1\n2,back,1,1,1,1\n"}}});
  static const Robot kMap = robot(
      "schema = \"kith.domain/1\"\nid = \"m\"\n[map]\nrows = [\"S.rG\"]\n[map.legend]\n\".\" = \"floor\"\n"
      "r = { terrain = \"rubble\", optional = true }\nS = { start = true }\nG = { goal = true }\n[[feature]]\n"
      "name = \"rubble\"\nwhen = \"leave:rubble\"\n[[feature]]\nname = \"step\"\nwhen = \"action\"\n",
      {});
  return first % 2 == 0 ? kModel : kMap;
}

// The table of a policy, and whether that says all: some of what the robot does may be no choice of the model.
std::pair<std::string, bool> table_of(const Domain& domain, const ObservedPolicy& policy) {
  std::string text = "world,state,action,probability\n";
  bool is_whole = true;
  for (MdpIndex m{0}; m.value() < domain.num_mdps(); ++m) {
    const Mdp& mdp = domain.mdp(m);
    for (StateIndex s{0}; s.value() < mdp.num_states(); ++s) {
      double sum = 0.0;
      for (std::size_t c = 0; c < mdp.choices(s).size(); ++c) {
        const double p = policy.probability[m.value()][mdp.first_choice(s) + c];
        fuzzing::require(p >= 0.0 && p <= 1.0 + 1e-9, "a probability");
        sum += p;
        if (!policy.is_seen[m.value()][s.value()]) continue;
        text += std::to_string(m.value()) + "," + domain.state_key(m, s) + "," +
                domain.action_names()[mdp.choices(s)[c].action.value()] + "," + std::to_string(p) + "\n";
      }
      fuzzing::require(sum <= 1.0 + 1e-9 && (policy.is_seen[m.value()][s.value()] || sum == 0.0), "sums to 1 at most");
      is_whole = is_whole && (!policy.is_seen[m.value()][s.value()] || sum > 1.0 - 1e-9);
    }
  }
  return {text, is_whole};
}

bool are_close(const ObservedPolicy& a, const ObservedPolicy& b) {
  if (a.is_seen != b.is_seen) return false;
  for (std::size_t m = 0; m < a.probability.size(); ++m) {
    for (std::size_t i = 0; i < a.probability[m].size(); ++i) {
      if (std::abs(a.probability[m][i] - b.probability[m][i]) > 1e-5) return false;
    }
  }
  return true;
}

void infer_and_read(const Robot& robot, const ObservedPolicy& policy) {
  std::optional<WeightInference> found;
  try {
    found = infer_weights(robot.domain, policy);
  } catch (const Error& error) {
    return fuzzing::require(error.kind() == ErrorKind::kInfeasible, "refused for what the robot does", error.what());
  }
  fuzzing::require(found->share > 0.0 && found->share <= 1.0 + 1e-9 && found->loss >= 0.0, "a share");
  const auto text = with_inferred_weights(robot.text, robot.domain.feature_names(), found->weights, as_inferred(*found),
                                          found->left_out);
  const auto again = parse_domain(text, "again.toml", {}, robot.files);
  fuzzing::require(again.domain.has_value(), "a domain with inferred weights is read", text);
  fuzzing::require(again.domain->num_starts() + found->left_out.size() == robot.domain.num_starts(), "its starts",
                   text);
}

}  // namespace

const fuzzing::Form fuzzing::kForm{.words = "policy", .head_bytes = 1};

fuzzing::Outcome fuzzing::run(std::string_view input) {
  if (input.empty()) return Outcome::kMalformed;
  const Robot& robot = robot_of(static_cast<unsigned char>(input.front()));
  const auto text = input.substr(1);
  const auto reading = parse_policy(text, kFile, robot.domain);
  fuzzing::require(reading.policy.has_value() != has_errors(reading.diagnostics), "a policy, or errors");
  const auto outcome = fuzzing::require_good(reading.diagnostics, text, kFile);
  if (!reading.policy) return outcome;
  const auto [table, is_whole] = table_of(robot.domain, *reading.policy);
  if (is_whole) {
    const auto again = parse_policy(table, kFile, robot.domain);
    fuzzing::require(again.policy && are_close(*again.policy, *reading.policy), "read as written", table);
  }
  infer_and_read(robot, *reading.policy);
  return outcome;
}
