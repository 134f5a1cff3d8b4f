#include "kith/fit/import_logs.hpp"

#include <algorithm>
#include <utility>

#include "kith/core/error.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/fit/import_run.hpp"
#include "kith/fit/import_trials.hpp"
#include "kith/table/csv_reader.hpp"
#include "kith/table/table_text.hpp"
#include "open_table.hpp"

namespace kith {
namespace {

namespace fs = std::filesystem;

constexpr const char* kResponses2021 = "lee2021_test_responses.csv";

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
  if (first_model == 0) to.policy = from.policy;
  if (to.policy != from.policy) to.policy.clear();  // of different domains
}

void add(ImportedLogs& all, const fs::path& path, AnswerDetail detail, PeopleRead people, const std::string& prefix) {
  std::error_code ignored;
  const bool folder = fs::is_directory(path, ignored);
  const auto responses = folder ? path / kResponses2021 : path;
  if (folder && !fs::exists(responses, ignored)) {
    append(all.logs, import_run_folder(path, detail, {}, people), prefix);
    return;
  }
  const auto columns = read_csv_header(read_table_text(responses), responses.string());
  if (has_column(columns, "interaction_type") || has_column(columns, "user_id")) {
    append(all.logs, import_trials(responses), prefix);
    return;
  }
  if (!has_column(columns, "participant") && !has_column(columns, "mdp_id")) {
    throw Error{{detail::fault("E0703", "this table is of no known layout", responses, 1,
                               "give the folder of a run, the folder of the Lee et al. (2021) tables, or a CSV "
                               "file with one row per trial (user_id, domain, interaction_type, ...)")}};
  }
  for (auto record : accuracy_records(read_lee2021_responses(responses))) {
    record.person.insert(0, prefix);
    all.accuracy.push_back(std::move(record));
  }
}

}  // namespace

ImportedLogs import_logs(const std::vector<fs::path>& paths, AnswerDetail detail, PeopleRead people) {
  ImportedLogs all;
  for (std::size_t i = 0; i < paths.size(); ++i) {
    add(all, paths[i], detail, people, paths.size() == 1 ? "" : std::to_string(i + 1) + ":");
  }
  if (!all.logs.people.empty() && !all.accuracy.empty()) {
    throw Error{{detail::fault("E0703", "logs with and without what people saw cannot be fitted together", paths.back(),
                               0, "fit them one after the other")}};
  }
  return all;
}

}  // namespace kith
