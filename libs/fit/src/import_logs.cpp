#include "kith/fit/import_logs.hpp"

#include <algorithm>
#include <utility>

#include "kith/core/error.hpp"
#include "kith/files/csv_reader.hpp"
#include "kith/files/table_text.hpp"
#include "open_table.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

bool has_column(const std::vector<Column>& columns, const std::string& name) {
  return std::any_of(columns.begin(), columns.end(), [&](const Column& column) { return column.name == name; });
}

void append(ResponseLogs& to, ResponseLogs from, const std::string& prefix) {
  const auto first_model = to.models.size();
  for (auto& person : from.people) {
    person.id = prefix + person.id;
    person.model += first_model;
    to.people.push_back(std::move(person));
  }
  to.models.insert(to.models.end(), from.models.begin(), from.models.end());
  to.notes.insert(to.notes.end(), from.notes.begin(), from.notes.end());
}

void add(ResponseLogs& all, const fs::path& path, AnswerDetail detail, const std::string& prefix) {
  std::error_code ignored;
  if (fs::is_directory(path, ignored)) return append(all, import_run_folder(path, detail), prefix);
  const auto columns = read_csv_header(read_table_text(path), path.string());
  if (!has_column(columns, "interaction_type") && !has_column(columns, "user_id")) {
    throw Error{{detail::fault("E0703", "this table is of no known layout", path, 1,
                               "give the folder of a run, or a CSV file with one row per trial (user_id, domain, "
                               "interaction_type, ...)")}};
  }
  append(all, import_trials(path), prefix);
}

}  // namespace

ResponseLogs import_logs(const std::vector<fs::path>& paths, AnswerDetail detail) {
  ResponseLogs all;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    add(all, paths[i], detail, paths.size() == 1 ? "" : std::to_string(i + 1) + ":");
  }
  return all;
}

}  // namespace kith
