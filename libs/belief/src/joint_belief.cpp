#include "kith/belief/aggregation.hpp"

namespace kith::detail {
namespace {

// The best alternative of all members' lists; an empty list fits everywhere.
std::vector<std::size_t> observe_joint(ParticleBelief& belief, const TeamResponses& responses, RandomStream random) {
  belief.observe_any(responses.lists, responses.likelihood, random);
  return {};
}

}  // namespace

AggregationRule joint_rule() { return {"joint", "what at least one member knows (union)", observe_joint, false}; }

}  // namespace kith::detail
