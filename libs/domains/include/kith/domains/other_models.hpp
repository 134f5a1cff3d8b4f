#pragma once

#include <filesystem>

namespace kith {

/// Models of PRISM and Gymnasium are made domains by kith.convert, a module of Python.
/// @throws kith::Error if this is the name of a file of theirs.
void refuse_models_of_others(const std::filesystem::path& path);

}  // namespace kith
