#pragma once

#include <span>

#include "kith/core/parameter.hpp"
#include "kith/toml/reader.hpp"

namespace kith {

// Reads declared parameters from a table of a study file: "ability.mean" is the key `mean` of the table `ability` in
// it. What is wrong goes to the report (E0107 to E0112; E0407 for a spread without exactly one of half_normal and
// value), and its parameter keeps its default. The caller finishes the table.
[[nodiscard]] ParameterValues read_parameters(TomlReader& table, std::span<const Parameter> declared);

// Adds every parameter to a table, so that reading it gives the same values again.
void write_parameters(const ParameterValues& values, TomlTable& table);

// Where to point at for a parameter or a table of parameters: its value, or the table as a whole if it is not set.
[[nodiscard]] TomlPlace place_of(std::string_view name, const TomlReader& table);

}  // namespace kith
