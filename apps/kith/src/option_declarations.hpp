#pragma once

#include <memory>
#include <string>

#include "options.hpp"

namespace CLI {  // NOLINT(readability-identifier-naming): theirs
class App;
}

namespace kith::cli {

/// The parser of all commands; what it understands goes to `options`, which must outlive it.
[[nodiscard]] std::unique_ptr<CLI::App> make_app(Options& options);

/// The command of that name. @throws std::out_of_range if there is none.
[[nodiscard]] Command command_of(const std::string& name);

}  // namespace kith::cli
