#pragma once

#include <span>
#include <string>

#include "kith/core/option_key.hpp"
#include "kith/files/reader.hpp"

namespace kith {

// Reads declared parameters from a table of a study file: "ability.mean" is the key `mean` of the table `ability` in
// it. What is wrong goes to the report (E0107 to E0112; E0407 for a spread without exactly one of half_normal and
// value), and its parameter keeps its default. The caller finishes the table.
[[nodiscard]] ParameterValues read_parameters(TomlReader& table, std::span<const Parameter> declared);

// Adds every parameter to a table, so that reading it gives the same values again.
void write_parameters(const ParameterValues& values, TomlTable& table);

// Reads into a struct those of its keys that the table has.
template <typename Options>
void read_options(TomlReader& table, std::span<const OptionKey<Options>> keys, Options& options) {
  for (const auto& key : keys) {
    if (!table.has(key.parameter.name)) continue;
    key.set(options, read_parameters(table, {&key.parameter, 1}).values().front());
  }
}

[[nodiscard]] TomlValue to_toml_value(const ParameterValue& value);

// Adds every key of a struct to a table.
template <typename Options>
void write_options(std::span<const OptionKey<Options>> keys, const Options& options, TomlTable& table) {
  for (const auto& key : keys) {
    if (key.is_written != nullptr && !key.is_written(options)) continue;
    table.append({std::string{key.parameter.name}, {}, to_toml_value(key.get(options))});
  }
}

// Where to point at for a parameter or a table of parameters: its value, or the table as a whole if it is not set.
[[nodiscard]] TomlPlace place_of(std::string_view name, const TomlReader& table);

}  // namespace kith
