#pragma once

#include "binding.hpp"
#include "kith/core/stream.hpp"

namespace kith::python {

/// A stream for code written in Python: deriving another leaves it as it is.
struct Stream {
  RandomStream stream{0};
};

}  // namespace kith::python
