#include "row_groups.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <string_view>

#include "kith/table/column_names.hpp"
#include "model.hpp"

namespace kith {
namespace {

// With fewer groups, the variance between them cannot be estimated usefully.
constexpr std::size_t kFewestGroups = 5;

constexpr std::array<std::string_view, 9> kIdentifierWords{"team",    "person",  "member",  "group", "participant",
                                                           "subject", "learner", "student", "id"};
// Of people, who may be numbered anew in every one of the others.
constexpr std::array<std::string_view, 8> kPeople{"person",  "member",  "participant", "subject",
                                                  "learner", "student", "user",        "seat"};
constexpr std::array<std::string_view, 3> kCollectives{"team", "group", "session"};
// "Age group" and "treatment group" are what people have in common, not who sits together.
constexpr std::array<std::string_view, 14> kAttributes{"age",    "blood",        "condition", "control", "diagnosis",
                                                       "ethnic", "experimental", "gender",    "income",  "language",
                                                       "risk",   "sex",          "treatment", "weight"};
// Of what people are asked or shown. No random intercepts are made of them unasked: the tests may be about just these.
constexpr std::array<std::string_view, 6> kItems{"item", "stimulus", "task", "question", "problem", "scenario"};

// "participant_id" and "participantID" have the words participant and id.
std::vector<std::string> words_of(const std::string& name) {
  std::vector<std::string> words(1);
  char before = '\0';
  for (const char c : name) {
    const bool is_upper = c >= 'A' && c <= 'Z', is_lower = c >= 'a' && c <= 'z';
    const bool was_lower = before >= 'a' && before <= 'z';
    if ((is_upper && was_lower) || (!is_upper && !is_lower)) words.emplace_back();
    if (is_upper || is_lower) words.back() += is_upper ? static_cast<char>(c - 'A' + 'a') : c;
    before = c;
  }
  words.erase(std::remove(words.begin(), words.end(), std::string{}), words.end());
  return words;
}

// Whether one of these is the last word of a column's name.
template <std::size_t n>
bool ends_in(const std::string& column, const std::array<std::string_view, n>& wanted) {
  const auto words = words_of(column);
  return !words.empty() && std::find(wanted.begin(), wanted.end(), words.back()) != wanted.end();
}

struct Identifier {
  std::string column;
  bool is_stated = false;  // by a codebook or the user, not just by its name
  Factor factor;
};

std::size_t num_combinations(const Factor& a, const Factor& b) {
  std::set<std::pair<std::size_t, std::size_t>> combinations;
  for (std::size_t i = 0; i < a.codes.size(); ++i) combinations.emplace(a.codes[i], b.codes[i]);
  return combinations.size();
}

// Whether the values of `inner` are numbers that begin anew in every `outer`, such as the members 1, 2, 3 of each team.
bool is_numbered_within(const Identifier& inner, const Identifier& outer) {
  if (!has_word(inner.column, kPeople) || !has_word(outer.column, kCollectives)) return false;
  std::map<std::size_t, std::set<std::size_t>> within;
  for (std::size_t i = 0; i < inner.factor.codes.size(); ++i)
    within[outer.factor.codes[i]].insert(inner.factor.codes[i]);
  std::size_t most = 0;
  for (const auto& [group, members] : within) most = std::max(most, members.size());
  return within.size() > 1 && inner.factor.levels.size() <= most;
}

std::vector<Identifier> identifiers_of(const Dataset& rows, const std::vector<std::string>& used) {
  std::vector<Identifier> identifiers;
  for (const auto& column : rows.columns()) {
    if (std::find(used.begin(), used.end(), column) != used.end()) continue;
    const auto kind = rows.kind(column);
    const bool is_stated = kind == ColumnKind::kIdentifier || column == columns::kSeedAddress;
    if (!is_stated && (kind != ColumnKind::kUnspecified || !is_identifier_name(column))) continue;
    const auto& cells = rows.cells(column);
    const auto has_value = [](const auto& cell) { return cell.has_value(); };
    if (std::none_of(cells.begin(), cells.end(), has_value)) continue;
    identifiers.push_back({column, is_stated, row_factor(rows, {column})});
  }
  return identifiers;
}

// Columns of items that occur in several rows each.
std::vector<std::string> items_of(const Dataset& rows, const std::vector<std::string>& used) {
  constexpr std::size_t kFewestItems = 3;
  std::vector<std::string> items;
  for (const auto& column : rows.columns()) {
    if (std::find(used.begin(), used.end(), column) != used.end() || !ends_in(column, kItems)) continue;
    const auto num_items = row_factor(rows, {column}).levels.size();
    if (num_items >= kFewestItems && num_items < rows.num_rows()) items.push_back(column);
  }
  return items;
}

// In kith's own tables without that address: replicates of a composition are the same people under every strategy,
// unless the study says otherwise.
std::vector<std::vector<std::string>> shared_people_of(const Dataset& rows, const std::vector<std::string>& used) {
  for (const auto* const column : {columns::kStrategy, columns::kComposition, columns::kReplicate, columns::kTeam}) {
    if (!rows.has(column)) return {};
  }
  const bool is_used = std::find(used.begin(), used.end(), columns::kReplicate) != used.end();
  if (rows.has(columns::kSeedAddress) || is_used) return {};
  std::vector<std::vector<std::string>> people{{columns::kComposition, columns::kReplicate}};
  if (rows.has(columns::kMember)) people.push_back({columns::kComposition, columns::kReplicate, columns::kMember});
  return people;
}

// Whether the grouping is none of those before, under another name.
bool is_new(const Factor& grouping, const std::vector<Factor>& known) {
  return std::none_of(known.begin(), known.end(), [&](const Factor& other) {
    return grouping.levels.size() == other.levels.size() && num_combinations(grouping, other) == other.levels.size();
  });
}

}  // namespace

bool has_word(const std::string& column, std::span<const std::string_view> wanted) {
  const auto words = words_of(column);
  return std::any_of(words.begin(), words.end(), [&](const std::string& word) {
    return std::find(wanted.begin(), wanted.end(), word) != wanted.end();
  });
}

bool is_identifier_name(const std::string& column) {
  const auto words = words_of(column);
  if (words.empty()) return false;
  auto last = words.back();
  const auto is_attribute = [&] {
    return std::find(kAttributes.begin(), kAttributes.end(), words[words.size() - 2]) != kAttributes.end();
  };
  if (last == "group" && words.size() > 1 && is_attribute()) return false;
  const auto is_known = [&] {
    return std::find(kIdentifierWords.begin(), kIdentifierWords.end(), last) != kIdentifierWords.end();
  };
  if (is_known()) return true;
  if (last.size() < 3 || last.compare(last.size() - 2, 2, "id") != 0) return false;
  last.resize(last.size() - 2);  // "teamid"
  return is_known();
}

Factor row_factor(const Dataset& rows, const std::vector<std::string>& columns) {
  std::vector<std::string> names(rows.num_rows());
  for (std::size_t c = 0; c < columns.size(); ++c) {
    const auto& cells = rows.cells(columns[c]);
    for (std::size_t i = 0; i < cells.size(); ++i) {
      if (c > 0) names[i] += ':';
      names[i] += cells[i] ? *cells[i] : c > 0 ? std::string{} : fmt::format("row {}", rows.line(i));
    }
  }
  std::string name;
  for (const auto& column : columns) name += (name.empty() ? "" : ":") + column;
  return make_factor(name, names);
}

RowGroups find_row_groups(const Dataset& rows, const std::vector<std::string>& used) {
  RowGroups groups;
  const auto identifiers = identifiers_of(rows, used);
  std::vector<Factor> known;

  const auto add = [&](const std::vector<std::string>& columns) {
    auto grouping = row_factor(rows, columns);
    if (grouping.levels.size() == rows.num_rows() || grouping.levels.size() < 2 || !is_new(grouping, known)) return;
    known.push_back(std::move(grouping));
    groups.intercepts.push_back(columns);
  };

  // Numbers that begin anew within another identifier say something only together with it.
  std::vector<const Identifier*> numbered;
  for (const auto& identifier : identifiers) {
    const auto outer = std::find_if(identifiers.begin(), identifiers.end(), [&](const Identifier& other) {
      return &other != &identifier && is_numbered_within(identifier, other);
    });
    if (outer != identifiers.end()) {
      numbered.push_back(&identifier);
      continue;
    }

    if (!identifier.is_stated && identifier.factor.levels.size() < kFewestGroups) {
      if (identifier.factor.levels.size() > 1)
        groups.notes.push_back(
            fmt::format("column '{}' is named like an identifier but has only {} values, so rows with the same value "
                        "are analysed as independent; add it to the model if it matters",
                        identifier.column, identifier.factor.levels.size()));
      continue;
    }
    add({identifier.column});
  }

  for (const auto* const inner : numbered) {
    const auto outer = std::find_if(identifiers.begin(), identifiers.end(), [&](const Identifier& other) {
      return &other != inner && is_numbered_within(*inner, other);
    });
    add({outer->column, inner->column});
  }

  for (const auto& people : shared_people_of(rows, used)) add(people);
  for (const auto& item : items_of(rows, used)) {
    const std::vector<std::string> alone{item};
    if (std::find(groups.intercepts.begin(), groups.intercepts.end(), alone) == groups.intercepts.end())
      groups.items.push_back(item);
  }
  return groups;
}

std::string intercepts_text(const std::vector<std::vector<std::string>>& intercepts) {
  std::string text;
  for (const auto& columns : intercepts) {
    std::string name;
    for (const auto& column : columns) name += (name.empty() ? "" : ":") + column;
    text += (text.empty() ? "(1|" : " + (1|") + name + ")";
  }
  return text;
}

}  // namespace kith
