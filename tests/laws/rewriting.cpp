#include "rewriting.hpp"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <map>
#include <numeric>
#include <sstream>
#include <stdexcept>

#include "kith/core/distributions.hpp"
#include "kith/core/text.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/files/document.hpp"

namespace kith::laws {
namespace {

TomlArray features_of(const DomainText& domain) {
  const auto* features = domain.root.find("feature");
  return features == nullptr ? TomlArray{} : *features->array();
}

std::string text_of(const TomlValue& table, std::string_view key) {
  const auto* value = table.table()->find(key);
  return value == nullptr ? std::string{} : *value->string();
}

void set(TomlTable& table, const std::string& key, TomlValue::Content value) {
  table.set({key, {}, TomlValue{std::move(value)}});
}

TomlTable* table_in(TomlTable& table, std::string_view key) {
  auto* value = table.find(key);
  return value == nullptr ? nullptr : value->table();
}

// The number times the factor, as a decimal of at most 14 digits.
double times(double x, double factor) {
  char text[40];
  std::snprintf(text, sizeof text, "%.14g", x * factor);
  return std::strtod(text, nullptr);
}

double number(const TomlValue& value) {
  return value.real() != nullptr ? *value.real() : static_cast<double>(*value.integer());
}

// Half-spaces of the prior and weights are tables from features to numbers.
void for_each_table_of_numbers(DomainText& domain, const std::function<void(TomlTable& table)>& change) {
  if (auto* reward = table_in(domain.root, "reward")) {
    if (auto* weights = table_in(*reward, "weights")) change(*weights);
  }
  if (auto* prior = table_in(domain.root, "prior")) {
    if (const auto* half_spaces = prior->find("halfspaces")) {
      TomlArray all = *half_spaces->array();
      for (auto& one : all) change(*one.table());
      set(*prior, "halfspaces", all);
    }
  }
}

bool has_map_of_rows(const DomainText& domain) {
  if (domain.root.find("model") != nullptr || domain.root.find("map") == nullptr) return false;
  const auto& map = *domain.root.find("map")->table();
  return map.find("rows") != nullptr && map.find("layer") == nullptr && map.find("raster") == nullptr;
}

// Where worlds or starts are drawn or chosen by number, a map that is turned over has others.
bool has_choices_by_position(const DomainText& domain) { return domain.root.find("family") != nullptr; }

std::vector<std::string> rows_of(const DomainText& domain) {
  std::vector<std::string> rows;
  for (const auto& row : *domain.root.find("map")->table()->find("rows")->array()) rows.push_back(*row.string());
  return rows;
}

Rewriting with_rows(const DomainText& domain, const std::string& how, const std::vector<std::string>& rows) {
  Rewriting result{how, domain};
  TomlArray array;
  for (const auto& row : rows) array.emplace_back(row);
  set(*table_in(result.text.root, "map"), "rows", array);
  for (std::size_t k = 0; k < features_of(domain).size(); ++k) result.counts.emplace_back(k);
  result.same_states = false;
  return result;
}

std::vector<std::string> split(const std::string& text, char at) {
  std::vector<std::string> parts;
  std::istringstream in{text};
  for (std::string part; std::getline(in, part, at);) parts.push_back(part);
  return parts;
}

bool is_name_character(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-'; }

// "leave:rubble & !action" with the names behind colons replaced.
std::string with_names(const std::string& condition, const std::map<std::string, std::string>& names) {
  std::string result;
  for (std::size_t i = 0; i < condition.size();) {
    result += condition[i];
    if (condition[i++] != ':') continue;
    const auto begin = i;
    while (i < condition.size() && is_name_character(condition[i])) ++i;
    const auto name = condition.substr(begin, i - begin);
    const auto found = names.find(name);
    result += found == names.end() ? name : found->second;
  }
  return result;
}

bool is_csv_model(const DomainText& domain) {
  const auto* model = domain.root.find("model");
  return model != nullptr && text_of(*model, "format") == "csv";
}

DomainFile& file_of(DomainText& domain, const char* key) {
  const auto name = text_of(*domain.root.find("model"), key);
  const auto file =
      std::find_if(domain.files.begin(), domain.files.end(), [&](const DomainFile& one) { return one.name == name; });
  if (file == domain.files.end()) throw std::logic_error{"no file " + name};
  return *file;
}

// The header with other names.
void rename_columns(DomainFile& file, const std::map<std::string, std::string>& names) {
  const auto end = file.text.find('\n');
  std::string header;
  for (auto name : split(file.text.substr(0, end), ',')) {
    const auto found = names.find(name);
    header += (header.empty() ? "" : ",") + (found == names.end() ? name : found->second);
  }
  file.text = header + file.text.substr(end);
}

void add_column(DomainFile& file, const std::string& name,
                const std::function<std::string(const std::string&)>& value) {
  std::string text;
  for (const auto& line : split(file.text, '\n')) {
    if (!line.empty()) text += line + "," + (text.empty() ? name : value(line)) + "\n";
  }
  file.text = text;
}

// Puts a feature at a position; `source`: the one whose condition and column it has, or none.
void insert_feature(Rewriting& rewriting, std::size_t at, std::optional<std::size_t> source) {
  auto& text = rewriting.text;
  auto features = features_of(text);
  const std::string name = source ? "copy" : "never";
  TomlTable table = source ? *features[*source].table() : TomlTable{};
  set(table, "name", name);
  if (is_csv_model(text)) {
    auto& transitions = file_of(text, "transitions");
    std::size_t column = 0;
    if (source) {
      const auto header = split(transitions.text.substr(0, transitions.text.find('\n')), ',');
      column = static_cast<std::size_t>(std::find(header.begin(), header.end(), text_of(features[*source], "name")) -
                                        header.begin());
    }
    add_column(transitions, name,
               [&](const std::string& line) { return source ? split(line, ',').at(column) : std::string{"0"}; });
  } else if (!source) {
    set(table, "when", std::string{"action & !action"});
  }
  features.insert(features.begin() + static_cast<std::ptrdiff_t>(at), TomlValue{table});
  set(text.root, "feature", features);
  rewriting.counts.insert(rewriting.counts.begin() + static_cast<std::ptrdiff_t>(at), source);
  rewriting.same_features = rewriting.same_vectors = false;
}

Rewriting unchanged(const DomainText& domain, const std::string& how) {
  Rewriting result{how, domain};
  for (std::size_t k = 0; k < features_of(domain).size(); ++k) result.counts.emplace_back(k);
  return result;
}

bool has_weights(const DomainText& domain) {
  const auto* reward = domain.root.find("reward");
  return reward != nullptr && reward->table()->find("weights") != nullptr;
}

}  // namespace

std::string DomainText::toml() const { return to_toml(root); }

DomainText domain_text(const std::string& name, std::string_view text, std::vector<DomainFile> files) {
  auto parsing = parse_toml(text, name);
  if (!parsing.document) throw std::logic_error{name + " is no TOML"};
  return {name, std::move(parsing.document->root), std::move(files)};
}

std::vector<DomainText> known_domains() {
  std::vector<DomainText> all;
  for (const auto& domain : built_in_domains())
    all.push_back(domain_text(std::string{domain.name}, domain.text, domain.files));
  const auto folder = std::filesystem::path{KITH_SOURCE_DIR} / "domains";
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::recursive_directory_iterator{folder}) {
    if (entry.path().extension() == ".toml") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  for (const auto& path : paths) {
    const auto reading = read_domain(path);
    if (!reading.domain) throw std::logic_error{path.string() + " is not sound"};
    const auto& id = reading.domain->id();
    const bool is_known = std::any_of(all.begin(), all.end(), [&](const DomainText& one) { return one.name == id; });
    if (!is_known) all.push_back(domain_text(id, read_file(path), reading.files));
  }
  return all;
}

std::optional<Rewriting> with_features_permuted(const DomainText& domain, RandomStream random) {
  const auto features = features_of(domain);
  std::vector<std::size_t> order(features.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = order.size(); i > 1; --i) std::swap(order[i - 1], order[uniform_index(i, random)]);
  // Of a group of exclusive features the first that holds is counted: they stay in order among themselves.
  std::map<std::string, std::vector<std::size_t>> places;
  for (std::size_t i = 0; i < order.size(); ++i) {
    const auto group = text_of(features[order[i]], "exclusive");
    if (!group.empty()) places[group].push_back(i);
  }
  for (const auto& [group, at] : places) {
    std::vector<std::size_t> members;
    for (const auto i : at) members.push_back(order[i]);
    std::sort(members.begin(), members.end());
    for (std::size_t j = 0; j < at.size(); ++j) order[at[j]] = members[j];
  }
  if (std::is_sorted(order.begin(), order.end())) return std::nullopt;
  Rewriting result{"features permuted", domain};
  TomlArray permuted;
  for (const auto k : order) {
    permuted.push_back(features[k]);
    result.how += " " + std::to_string(k);
    result.counts.emplace_back(k);
  }
  set(result.text.root, "feature", permuted);
  result.same_vectors = false;
  return result;
}

std::optional<Rewriting> with_weights_scaled(const DomainText& domain, double factor) {
  if (!has_weights(domain)) return std::nullopt;
  auto result = unchanged(domain, "weights times " + to_toml(TomlValue{factor}));
  auto& weights = *table_in(*table_in(result.text.root, "reward"), "weights");
  const auto old_weights = weights;
  for (const auto& entry : old_weights.entries()) set(weights, entry.key, times(number(entry.value), factor));
  return result;
}

std::optional<Rewriting> mirrored(const DomainText& domain) {
  if (!has_map_of_rows(domain) || has_choices_by_position(domain)) return std::nullopt;
  auto rows = rows_of(domain);
  for (auto& row : rows) std::reverse(row.begin(), row.end());
  return with_rows(domain, "mirrored", rows);
}

std::optional<Rewriting> transposed(const DomainText& domain) {
  if (!has_map_of_rows(domain) || has_choices_by_position(domain)) return std::nullopt;
  const auto rows = rows_of(domain);
  std::vector<std::string> columns(rows.front().size());
  for (const auto& row : rows)
    for (std::size_t x = 0; x < row.size(); ++x) columns[x] += row[x];
  return with_rows(domain, "transposed", columns);
}

std::optional<Rewriting> renamed(const DomainText& domain) {
  const auto* map = domain.root.find("map");
  const bool has_layers =
      map != nullptr && (map->table()->find("layer") != nullptr || map->table()->find("raster") != nullptr);
  if (has_layers || has_choices_by_position(domain) || !has_weights(domain)) return std::nullopt;
  if (domain.root.find("model") != nullptr && !is_csv_model(domain)) return std::nullopt;
  auto result = unchanged(domain, "renamed");
  auto& root = result.text.root;
  set(root, "id", std::string{"renamed"});
  auto features = features_of(domain);
  std::map<std::string, std::string> names, things;  // later ones come earlier in the alphabet
  for (std::size_t k = 0; k < features.size(); ++k) {
    names[text_of(features[k], "name")] = std::string(1, static_cast<char>('z' - k)) + "-feature";
  }
  if (auto* table = table_in(root, "map"); table != nullptr && domain.root.find("model") == nullptr) {
    TomlTable& legend = *table_in(*table, "legend");
    char letter = 'z';
    const auto old_legend = legend;
    for (const auto& entry : old_legend.entries()) {
      if (entry.value.table() == nullptr) continue;
      TomlTable one = *entry.value.table();
      for (const char* kind : {"terrain", "station", "item", "destination", "goal"}) {
        const auto* name = one.find(kind);
        if (name == nullptr || name->string() == nullptr) continue;
        const auto [known, is_new] = things.emplace(*name->string(), std::string(1, letter) + "-thing");
        if (is_new) --letter;
        set(one, kind, known->second);
      }
      set(legend, entry.key, one);
    }
  }
  for (auto& feature : features) {
    TomlTable& table = *feature.table();
    set(table, "name", names.at(text_of(feature, "name")));
    if (table.find("when") != nullptr) set(table, "when", with_names(text_of(feature, "when"), things));
  }
  set(root, "feature", features);
  if (const auto* rules = domain.root.find("rule")) {
    TomlArray all = *rules->array();
    for (auto& rule : all) set(*rule.table(), "when", with_names(text_of(rule, "when"), things));
    set(root, "rule", all);
  }
  for_each_table_of_numbers(result.text, [&](TomlTable& table) {
    TomlTable other;
    for (const auto& entry : table.entries()) other.append({names.at(entry.key), {}, entry.value});
    table = other;
  });
  if (auto* words = table_in(root, "words")) {
    TomlTable other;
    for (const auto& entry : words->entries()) other.append({names.at(entry.key), {}, entry.value});
    *words = other;
  }
  if (is_csv_model(domain)) rename_columns(file_of(result.text, "transitions"), names);
  return result;
}

std::optional<Rewriting> with_a_feature_that_never_occurs(const DomainText& domain, RandomStream random) {
  const auto d = features_of(domain).size();
  if (d >= 8 || !has_weights(domain) || (domain.root.find("model") != nullptr && !is_csv_model(domain)))
    return std::nullopt;
  auto result = unchanged(domain, "with a feature that never occurs");
  insert_feature(result, uniform_index(d + 1, random), std::nullopt);
  set(*table_in(*table_in(result.text.root, "reward"), "weights"), "never", -1.5);
  return result;
}

std::optional<Rewriting> with_a_copy_of_a_feature(const DomainText& domain, RandomStream random) {
  const auto features = features_of(domain);
  if (features.size() >= 8 || !has_weights(domain) || (domain.root.find("model") != nullptr && !is_csv_model(domain)))
    return std::nullopt;
  const auto k = uniform_index(features.size(), random);
  if (!text_of(features[k], "exclusive").empty()) return std::nullopt;
  const auto name = text_of(features[k], "name");
  auto result = unchanged(domain, "with a copy of " + name);
  insert_feature(result, uniform_index(features.size() + 1, random), k);
  auto& weights = *table_in(*table_in(result.text.root, "reward"), "weights");
  const double half = times(number(*weights.find(name)), 0.5);
  for_each_table_of_numbers(result.text, [&](TomlTable& table) {
    if (const auto* value = table.find(name)) set(table, "copy", number(*value));
  });
  set(weights, name, half);
  set(weights, "copy", half);
  return result;
}

std::optional<Rewriting> with_a_world_twice(const DomainText& domain) {
  if (!is_csv_model(domain)) return std::nullopt;
  auto result = unchanged(domain, "with a world twice");
  result.same_states = result.same_vectors = false;
  std::string first;
  for (const char* key : {"transitions", "states"}) {
    auto& file = file_of(result.text, key);
    const auto lines = split(file.text, '\n');
    const auto header = split(lines.front(), ',');
    const auto column = static_cast<std::size_t>(std::find(header.begin(), header.end(), "mdp") - header.begin());
    if (column == header.size()) {
      if (std::string{key} == "transitions") return std::nullopt;
      continue;  // all MDPs share the states
    }
    for (std::size_t i = 1; i < lines.size(); ++i) {
      auto cells = split(lines[i], ',');
      if (cells.size() < header.size()) continue;
      if (first.empty()) first = cells[column];
      if (cells[column] != first) continue;
      cells[column] = "again";
      file.text += joined(cells, ",") + "\n";
    }
  }
  return result;
}

DomainText with_discount(const DomainText& domain, double discount) {
  DomainText result = domain;
  auto* mdp = table_in(result.root, "mdp");
  if (mdp == nullptr) {
    set(result.root, "mdp", TomlTable{});
    mdp = table_in(result.root, "mdp");
  }
  set(*mdp, "discount", discount);
  return result;
}

}  // namespace kith::laws
