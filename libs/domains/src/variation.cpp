// Edits domain files as text, so that what people wrote in them stays.
#include "kith/domains/variation.hpp"

#include <algorithm>
#include <cctype>

#include "kith/domains/domain_file.hpp"
#include "kith/files/document.hpp"

namespace kith {
namespace {

// Walks through a TOML text and says which characters are code, outside strings and comments.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : is_code_(text.size(), true) {
    char quote = 0;
    bool comment = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
      const char c = text[i];
      if (comment) {
        comment = c != '\n';
        is_code_[i] = !comment;
      } else if (quote != 0) {
        is_code_[i] = false;
        if (c == '\\' && quote == '"' && i + 1 < text.size()) {
          is_code_[++i] = false;
        } else if (c == quote) {
          quote = 0;
        }
      } else if (c == '"' || c == '\'') {
        quote = c;
        is_code_[i] = false;
      } else if (c == '#') {
        comment = true;
        is_code_[i] = false;
      }
    }
  }

  [[nodiscard]] bool is_code(std::size_t i) const { return is_code_[i]; }

 private:
  std::vector<bool> is_code_;
};

constexpr auto kNowhere = std::string_view::npos;

bool is_key_character(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-'; }

// Where `key =` or `"key" =` begins at or after `from`, as code.
std::size_t find_key(std::string_view text, const Scanner& scanner, std::string_view key, std::size_t from) {
  for (auto at = text.find(key, from); at != kNowhere; at = text.find(key, at + 1)) {
    const auto end = at + key.size();
    const char before = at > 0 ? text[at - 1] : '\n';
    const bool is_quoted = (before == '"' || before == '\'') && end < text.size() && text[end] == before;
    if (!is_quoted && (!scanner.is_code(at) || is_key_character(before))) continue;
    const auto next = text.find_first_not_of(" \t", end + (is_quoted ? 1 : 0));
    if (next != kNowhere && text[next] == '=') return is_quoted ? at - 1 : at;
  }
  return kNowhere;
}

// The first of these characters that is code.
std::size_t find_code(std::string_view text, const Scanner& scanner, std::string_view characters, std::size_t from) {
  for (auto at = text.find_first_of(characters, from); at != kNowhere; at = text.find_first_of(characters, at + 1)) {
    if (scanner.is_code(at)) return at;
  }
  return kNowhere;
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') result += '\\';
    result += c;
  }
  return result + "\"";
}

// Puts `value` where the value of a key stands.
bool replace_value(std::string& text, std::string_view key, char last, const std::string& value) {
  const Scanner scanner{text};
  const auto at = find_key(text, scanner, key, 0);
  if (at == kNowhere) return false;
  const auto begin = text.find_first_not_of(" \t", text.find('=', at) + 1);
  if (begin == kNowhere) return false;
  std::size_t end = kNowhere;
  if (last == ']') {
    end = find_code(text, scanner, "]", begin);
  } else {
    end = text.find(text[begin], begin + 1);  // the closing quote: ids have none inside
  }
  if (end == kNowhere) return false;
  text.replace(begin, end + 1 - begin, value);
  return true;
}

// Removes `optional = ...` from the tables of the legend.
void remove_options(std::string& text) {
  for (std::size_t from = 0;;) {
    const Scanner scanner{text};
    auto begin = find_key(text, scanner, "optional", from);
    if (begin == kNowhere) return;
    auto end = find_code(text, scanner, ",}\n", begin);
    if (end == kNowhere) end = text.size();
    if (end < text.size() && text[end] == ',') {
      end = text.find_first_not_of(" \t", end + 1);
    } else {
      const auto comma = text.find_last_not_of(" \t", begin - 1);
      if (comma != kNowhere && text[comma] == ',') begin = comma;
      while (end > begin && (text[end - 1] == ' ' || text[end - 1] == '\t')) --end;
    }
    text.erase(begin, end - begin);
    from = begin;
  }
}

// Removes a table, however it is written: [name], ["name"], name = { ... }, name.key = ...
void remove_table(std::string& text, const std::string& name) {
  const Scanner scanner{text};
  std::string kept;
  bool in_root = true, in_table = false;
  for (std::size_t at = 0, end = 0; at < text.size(); at = end) {
    int depth = 0;
    for (bool is_over = false; end < text.size() && !is_over; ++end) {
      const char c = text[end];
      if (!scanner.is_code(end)) continue;
      depth += (c == '[' || c == '{' ? 1 : 0) - (c == ']' || c == '}' ? 1 : 0);
      is_over = c == '\n' && depth == 0;
    }
    const auto statement = text.substr(at, end - at);
    const auto begin = std::min(statement.find_first_not_of(" \t"), statement.size() - 1);
    const auto key = std::min(statement.find_first_not_of(" \t[\"'"), statement.size());
    const bool is_it = statement.substr(key, statement.find_first_of(" \t.]=\"'\r\n", key) - key) == name;
    if (statement[begin] == '[') {
      in_root = false;
      in_table = is_it;
    }
    if (!in_table && !(in_root && is_it)) kept += statement;
  }
  text = kept;
}

}  // namespace

// An array with a list for each world: its number, and then states of it. Nothing without states.
std::string by_world(const std::string& key, const std::string& what, const std::vector<StartId>& states) {
  if (states.empty()) return "";
  std::string lists;
  for (std::size_t i = 0; i < states.size(); ++i) {
    if (i == 0 || states[i].mdp != states[i - 1].mdp)
      lists += (i == 0 ? "\n  [" : "],\n  [") + std::to_string(states[i].mdp.value());
    lists += ", " + std::to_string(states[i].start.value());
  }
  return "\n" + key + " = [  # worlds, each with " + what + lists + "],\n]";
}

std::string with_inferred_weights(std::string_view text, const std::vector<std::string>& features,
                                  const std::vector<double>& weights, const InferredWeights& inferred,
                                  const std::vector<StartId>& left_out) {
  std::string result{text};
  remove_table(result, "reward");
  remove_table(result, "inferred");
  while (!result.empty() && result.back() == '\n') result.pop_back();

  std::string values;
  for (std::size_t k = 0; k < features.size(); ++k)
    values += (k == 0 ? "" : ", ") + quoted(features[k]) + " = " + to_toml(TomlValue{weights[k]});
  return result + "\n\n[reward]\nweights = { " + values +
         " }\n\n[inferred]   # how well these weights explain the robot; 'kith infer' wrote both tables\nshare = " +
         to_toml(TomlValue{inferred.share}) + "\nloss = " + to_toml(TomlValue{inferred.loss}) +
         "\nmargin = " + to_toml(TomlValue{inferred.margin}) +
         by_world("left_out", "the starts that are not taught", left_out) +
         by_world("not_explained", "the states that these weights do not explain", inferred.not_explained) + "\n";
}

std::optional<std::string> with_one_map(std::string_view text, const std::string& id,
                                        const std::vector<std::string>& rows) {
  std::string result{text};
  std::string array = "[";
  for (std::size_t i = 0; i < rows.size(); ++i) array += (i == 0 ? "" : ",\n        ") + quoted(rows[i]);
  if (!replace_value(result, "id", '"', quoted(id)) || !replace_value(result, "rows", ']', array + "]")) {
    return std::nullopt;
  }
  remove_options(result);
  const auto reading = parse_domain(result, id);
  if (!reading.domain || reading.domain->num_mdps() != 1) return std::nullopt;
  const auto map = reading.domain->map();
  if (!map || map->draw(MdpIndex{0}, std::nullopt) != rows) return std::nullopt;
  return result;
}

}  // namespace kith
