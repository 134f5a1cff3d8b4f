// What an error id means: the tables of docs/errors.md, which are the registry of ids. And what kinds there are.
#include <algorithm>
#include <cctype>
#include <string_view>

#include "command.hpp"
#include "embedded.hpp"
#include "kind_lists.hpp"
#include "kith/core/diagnostic.hpp"
#include "kith/present/wrapped.hpp"

namespace kith::cli {
namespace {

struct ExplainOptions {
  std::string id;  ///< "E0207", or a list of kinds ("strategies"); empty: list all ids.
};

struct ErrorEntry {
  std::string id, meaning, example, section;
  bool infeasible = false;
};

// "[limits](limits.md)" -> "limits", "`seed`" -> "'seed'".
std::string plain_text(std::string_view markdown) {
  std::string text;
  for (std::size_t i = 0; i < markdown.size(); ++i) {
    const auto rest = markdown.substr(i);
    const auto middle = rest.find("](");
    const auto end = middle == std::string_view::npos ? middle : rest.find(')', middle);
    const bool is_link = rest.front() == '[' && end != std::string_view::npos && rest.find(']') == middle;
    if (is_link) {
      text += plain_text(rest.substr(1, middle - 1));
      i += end;
    } else if (rest.front() == '`') {
      text += '\'';
    } else if (rest.front() == '\\' && rest.size() > 1 && rest[1] == '|') {
      text += '|';
      ++i;
    } else if (rest.front() != '*') {
      text += rest.front();
    }
  }
  return text;
}

// The cells of "| a | b |".
std::vector<std::string_view> cells_of(std::string_view row) {
  std::vector<std::string_view> cells;
  std::size_t begin = 1;
  for (std::size_t i = 1; i < row.size(); ++i) {
    if (row[i] != '|' || row[i - 1] == '\\') continue;
    auto cell = row.substr(begin, i - begin);
    while (!cell.empty() && cell.front() == ' ') cell.remove_prefix(1);
    while (!cell.empty() && cell.back() == ' ') cell.remove_suffix(1);
    cells.push_back(cell);
    begin = i + 1;
  }
  return cells;
}

bool is_id(std::string_view text) {
  constexpr std::size_t kLength = 5;
  return text.size() == kLength && (text.front() == 'E' || text.front() == 'W') &&
         std::all_of(text.begin() + 1, text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

std::vector<ErrorEntry> error_entries() {
  constexpr std::string_view kInfeasible = "*infeasible:* ";
  std::vector<ErrorEntry> entries;
  std::string section;
  for (auto page = detail::kErrorPage; !page.empty();) {
    const auto end = page.find('\n');
    const auto line = page.substr(0, end);
    page.remove_prefix(end == std::string_view::npos ? page.size() : end + 1);
    if (line.rfind("## ", 0) == 0)
      section = plain_text(line.substr(line.find(": ") == std::string_view::npos ? 3 : line.find(": ") + 2));
    if (line.rfind("| ", 0) != 0) continue;
    const auto cells = cells_of(line);
    if (cells.size() < 2 || !is_id(cells.front())) continue;
    auto meaning = cells[1];
    const bool infeasible = meaning.rfind(kInfeasible, 0) == 0;
    if (infeasible) meaning.remove_prefix(kInfeasible.size());
    entries.push_back({std::string{cells.front()}, plain_text(meaning), cells.size() > 2 ? plain_text(cells[2]) : "",
                       section, infeasible});
  }
  std::sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return entries;
}

std::string entry_text(const ErrorEntry& entry, const Console& console) {
  constexpr std::size_t kIndent = 9;
  const std::string blank(kIndent, ' ');
  const auto field = [&](std::string name, const std::string& text) {
    name.resize(kIndent, ' ');
    return text.empty() ? std::string{} : name + wrapped(text, kTextWidth - kIndent, blank) + "\n";
  };
  const auto* kind = entry.id.front() == 'W' ? "warning" : entry.infeasible ? "error, infeasible" : "error";
  return console.bold(entry.id) + " (" + kind + ")\n" + field("meaning", entry.meaning) +
         field("example", entry.example) + field("about", entry.section);
}

void declare(OptionList& list, ExplainOptions& options) {
  list.text(
      "topic", options.id, "TOPIC",
      "An id, such as E0207, or learners, strategies, beliefs, stop-rules or discussions; without one, all ids are "
      "listed");
}

int run(const ExplainOptions& options, Console& console) {
  const auto kinds = kind_lists();
  const auto topic =
      std::find_if(kinds.begin(), kinds.end(), [&](const auto& list) { return list.topic == options.id; });
  if (topic != kinds.end()) {
    console.print(to_text(*topic, console));
    return 0;
  }
  const auto entries = error_entries();
  if (options.id.empty()) {
    std::string text;
    for (const auto& entry : entries)
      text += entry.id + "  " + wrapped(entry.meaning, kTextWidth - 7, "       ") + "\n";
    console.print(text);
    return 0;
  }
  auto id = options.id;
  std::transform(id.begin(), id.end(), id.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  const auto found = std::find_if(entries.begin(), entries.end(), [&](const auto& entry) { return entry.id == id; });
  if (found == entries.end()) {
    std::vector<std::string> known;
    for (const auto& entry : entries) known.push_back(entry.id);
    for (const auto& list : kinds) known.emplace_back(list.topic);
    const auto by_id = nearest_word(id, known);
    const auto nearest = by_id.empty() ? nearest_word(options.id, known) : by_id;
    refuse("kith has no error or warning '" + options.id + "'",
           nearest.empty()
               ? "`kith explain` lists all ids; learners, strategies, beliefs, stop-rules and discussions are topics"
               : "did you mean '" + nearest + "'?");
  }
  console.print(entry_text(*found, console));
  return 0;
}

}  // namespace

void add_explain(Commands& commands) {
  commands.add<ExplainOptions>("explain", "Say what an error id means, or list kinds and their parameters",
                               {"kith explain E0207", "kith explain strategies"}, declare, run);
}

}  // namespace kith::cli
