#include "run_files.hpp"

#include "kith/runs/run_folder.hpp"
#include "kith/study/read_records.hpp"

namespace kith::detail {

RunFiles open_run(const std::filesystem::path& folder, const StudyKinds& kinds) {
  auto published = PublishedRun::open(folder);
  auto reading = read_run_folder(folder, kinds);
  if (!reading.study || !reading.domain) throw Error{reading.diagnostics};
  auto teams = published.missing().empty() ? team_addresses(*reading.study)
                                           : present_teams(*reading.study, published.read("tables/teams.csv"),
                                                           (folder / "tables" / "teams.csv").string());
  auto study_toml = published.read("inputs/study.toml");
  auto domain_toml = published.read("inputs/domain.toml");
  auto manifest = Json::parse(published.manifest());
  return {folder,
          *std::move(reading.study),
          *std::move(reading.domain),
          std::move(teams),
          std::move(study_toml),
          std::move(domain_toml),
          std::move(manifest),
          std::move(published)};
}

std::string table_text(const RunFiles& run, const std::string& table) { return run.published.read("tables/" + table); }

std::string manifest_text(const RunFiles& run, const std::string& key) {
  const auto found = run.manifest.find(key);
  return found != run.manifest.end() && found->is_string() ? found->get<std::string>() : std::string{};
}

}  // namespace kith::detail
