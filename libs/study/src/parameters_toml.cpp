#include "parameters_toml.hpp"

#include <algorithm>
#include <map>
#include <set>

namespace kith {
namespace {

// "ability" and "mean" of "ability.mean"; the first is empty for other names.
struct Name {
  explicit Name(std::string_view whole) {
    const auto dot = whole.find('.');
    if (dot != std::string_view::npos) table = whole.substr(0, dot);
    key = dot == std::string_view::npos ? whole : whole.substr(dot + 1);
  }
  std::string_view table;
  std::string_view key;
};

class ParametersReader {
 public:
  ParametersReader(TomlReader& table, std::span<const Parameter> declared)
      : table_{table}, declared_{declared}, values_{declared} {}

  ParameterValues read() {
    for (const auto& parameter : declared_) {
      const Name name{parameter.name};
      if (name.table.empty()) {
        read_one(table_, name.key, parameter);
      } else if (auto* inner = inner_table(name.table)) {
        read_one(*inner, name.key, parameter);
      }
    }
    for (auto& [name, inner] : inner_) {
      if (inner) inner->finish();
    }
    return std::move(values_);
  }

 private:
  // Null if it is not there, which is reported if anything in it is required.
  TomlReader* inner_table(std::string_view name) {
    auto found = inner_.find(name);
    if (found == inner_.end()) {
      const bool required = std::any_of(declared_.begin(), declared_.end(), [&](const Parameter& one) {
        return one.is_required && Name{one.name}.table == name;
      });
      if (const auto* value = table_.content().find(name); value != nullptr && value->table() == nullptr) {
        show_table(name, *value);
        return nullptr;
      }
      found = inner_.emplace(name, table_.table(name, required ? Presence::kRequired : Presence::kOptional)).first;
    }
    return found->second ? &*found->second : nullptr;
  }

  // "ability = 0.7" where a table is wanted.
  void show_table(std::string_view name, const TomlValue& value) {
    table_.know(name);
    std::string keys;
    for (const auto& parameter : declared_) {
      const Name own{parameter.name};
      if (own.table != name) continue;
      const auto text = keys.empty() && value.is_number() ? to_toml(value) : to_string(parameter.default_value);
      keys += (keys.empty() ? "" : ", ") + std::string{own.key} + " = " + text;
    }
    const auto key = std::string{name};
    if (!shown_.insert(key).second) return;
    table_.report().error("E0108", value.place(),
                          "'" + key + "' must be a table, not " + std::string{value.kind_name()},
                          "write " + key + " = { " + keys + " }");
  }

  void read_one(TomlReader& table, std::string_view key, const Parameter& parameter) {
    const auto presence = parameter.is_required ? Presence::kRequired : Presence::kOptional;
    const RealRange range{parameter.min, parameter.max, parameter.min_is_open, parameter.max_is_open};
    const auto& type = parameter.default_value;
    if (std::holds_alternative<double>(type)) {
      set(parameter, table.real(key, presence, range));
    } else if (std::holds_alternative<std::int64_t>(type)) {
      set(parameter,
          table.integer(key, presence,
                        {static_cast<std::int64_t>(parameter.min), static_cast<std::int64_t>(parameter.max)}));
    } else if (std::holds_alternative<bool>(type)) {
      set(parameter, table.boolean(key, presence));
    } else if (std::holds_alternative<std::string>(type)) {
      read_string(table, key, presence, parameter);
    } else {
      read_spread(table, key, presence, parameter);
    }
  }

  void read_string(TomlReader& table, std::string_view key, Presence presence, const Parameter& parameter) {
    if (parameter.words.empty()) return set(parameter, table.string(key, presence));
    const std::vector<std::string> words(parameter.words.begin(), parameter.words.end());
    if (const auto word = table.word(key, presence, words)) values_.set(parameter.name, words[*word]);
  }

  void read_spread(TomlReader& table, std::string_view key, Presence presence, const Parameter& parameter) {
    if (const auto* value = table.content().find(key); value != nullptr && value->is_number()) {
      table.know(key);
      const auto name = std::string{key}, number = to_toml(*value);
      return table.report().error("E0108", value->place(),
                                  "'" + name + "' must be a table, not " + std::string{value->kind_name()},
                                  "write " + name + " = { value = " + number + " } for everybody, or " + name +
                                      " = { half_normal = " + number + " } to draw it for each person");
    }
    auto reader = table.table(key, presence);
    if (!reader) return;
    const RealRange range{parameter.min, parameter.max, parameter.min_is_open, parameter.max_is_open};
    const Spread spread{.half_normal = reader->real("half_normal", Presence::kOptional, range),
                        .value = reader->real("value", Presence::kOptional, range)};
    reader->finish();
    if (reader->has("half_normal") == reader->has("value")) {
      const std::string name{key};
      reader->report().error("E0407", reader->place(), "'" + name + "' needs either half_normal or value",
                             "write " + name + " = { half_normal = 0.05 } or { value = 0.05 }");
    } else if (spread.half_normal || spread.value) {
      values_.set(parameter.name, spread);
    }
  }

  template <typename Value>
  void set(const Parameter& parameter, const std::optional<Value>& value) {
    if (value) values_.set(parameter.name, *value);
  }

  TomlReader& table_;
  std::span<const Parameter> declared_;
  ParameterValues values_;
  std::map<std::string_view, std::optional<TomlReader>> inner_;
  std::set<std::string> shown_;  // tables that are none
};

}  // namespace

ParameterValues read_parameters(TomlReader& table, std::span<const Parameter> declared) {
  return ParametersReader{table, declared}.read();
}

TomlValue to_toml_value(const ParameterValue& value) {
  if (const auto* real = std::get_if<double>(&value)) return TomlValue{*real};
  if (const auto* count = std::get_if<std::int64_t>(&value)) return TomlValue{*count};
  if (const auto* boolean = std::get_if<bool>(&value)) return TomlValue{*boolean};
  if (const auto* word = std::get_if<std::string>(&value)) return TomlValue{*word};
  const auto& spread = std::get<Spread>(value);
  TomlTable table;
  if (spread.half_normal) table.append({"half_normal", {}, TomlValue{*spread.half_normal}});
  if (spread.value) table.append({"value", {}, TomlValue{*spread.value}});
  return TomlValue{std::move(table)};
}

void write_parameters(const ParameterValues& values, TomlTable& table) {
  for (std::size_t i = 0; i < values.values().size(); ++i) {
    const Name name{values.declared()[i].name};
    TomlTable* target = &table;
    if (!name.table.empty()) {
      if (table.find(name.table) == nullptr) table.append({std::string{name.table}, {}, TomlValue{TomlTable{}}});
      target = table.find(name.table)->table();
    }
    target->append({std::string{name.key}, {}, to_toml_value(values.values()[i])});
  }
}

TomlPlace place_of(std::string_view name, const TomlReader& table) {
  const Name parts{name};
  const auto* inner = &table.content();
  if (!parts.table.empty()) {
    const auto* value = inner->find(parts.table);
    inner = value != nullptr ? value->table() : nullptr;
  }
  const auto* value = inner != nullptr ? inner->find(parts.key) : nullptr;
  return value != nullptr ? value->place() : table.place();
}

}  // namespace kith
