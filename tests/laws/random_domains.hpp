#pragma once

#include "kith/core/stream.hpp"
#include "rewriting.hpp"

namespace kith::laws {

/// A sound domain on a map of a few cells: terrain, walls, a charger, something to deliver or a goal; two to five
/// features in any order, weights of two decimals, at most 32 worlds.
[[nodiscard]] DomainText random_map(RandomStream random);

/// An explicit model of a few states in which every action ends elsewhere with probability `slip`: one or two worlds,
/// two to four features in any order. Without chance if `slip` is 0 or 1.
[[nodiscard]] DomainText random_model(RandomStream random, double slip, double discount = 1.0);

/// A robot that does not always arrive: with this discount, walking on for ever is worth -5, and crossing rubble -8.
[[nodiscard]] DomainText robot_that_never_ends();

}  // namespace kith::laws
