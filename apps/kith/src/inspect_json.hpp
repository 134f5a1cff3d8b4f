#pragma once

#include "console.hpp"
#include "kith/bec/atlas.hpp"

namespace kith::cli {

/// Prints the document kith.inspect/1: everything about the domain, and with
/// `--show demos` every demonstration (of one MDP with --mdp).
void print_inspection(const Atlas& atlas, const InspectOptions& options, Console& console);

/// The same document for a domain that cannot be taught, without what concerns teaching.
void print_inspection(const Domain& domain, Console& console);

}  // namespace kith::cli
