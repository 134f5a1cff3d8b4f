#include "kith/mdp/policy_partition.hpp"

#include "policy_partition_body.hpp"

namespace kith {

PolicyPartition::PolicyPartition(const Mdp& mdp, std::span<const StateIndex> states, std::vector<double> robot_weights,
                                 const BehaveOptions& options)
    : body_{std::make_unique<Body>(mdp, states, std::move(robot_weights), options)} {}
PolicyPartition::PolicyPartition(PolicyPartition&&) noexcept = default;
PolicyPartition& PolicyPartition::operator=(PolicyPartition&&) noexcept = default;
PolicyPartition::~PolicyPartition() = default;

std::size_t PolicyPartition::num_parts() const noexcept { return body_->num_parts(); }
std::size_t PolicyPartition::memory() const noexcept { return body_->memory(); }

}  // namespace kith
