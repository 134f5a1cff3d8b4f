#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "input.hpp"
#include "kith/core/error.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/present/json.hpp"
#include "templates.hpp"

namespace kith::cli {
namespace {

struct NewFile {
  std::string name, content;
};

std::vector<NewFile> files_of(const std::string& name) {
  const bool human = name == "human-study";
  std::vector<NewFile> files;
  files.push_back(
      {"domain.toml", name == "blank" ? std::string{detail::kBlankDomain} : read_named("item-delivery").text});
  files.push_back({"study.toml", std::string{human ? detail::kHumanStudyTemplate : detail::kStudyTemplate}});
  files.push_back(
      {"README.md", std::string{detail::kReadmeTemplate} + std::string{human ? detail::kHumanStudyReadme : ""}});
  if (human) files.push_back({"consent.md", std::string{detail::kConsentTemplate}});
  return files;
}

}  // namespace

int run_init(const InitOptions& options, Console& console) {
  const std::filesystem::path folder{options.folder};
  const auto files = files_of(options.template_name);
  // Everything or nothing: what people have written is never replaced.
  for (const auto& file : files) {
    std::error_code failure;
    if (std::filesystem::exists(std::filesystem::symlink_status(folder / file.name, failure))) {
      throw Error{ErrorKind::kUsage, (folder / file.name).string() + " exists already; name another folder"};
    }
  }
  std::error_code failure;
  std::filesystem::create_directories(folder, failure);
  if (failure) throw Error{ErrorKind::kIo, "cannot make the folder " + folder.string() + ": " + failure.message()};
  for (const auto& file : files) write_file_atomically(folder / file.name, file.content);

  if (console.json()) {
    Json names = Json::array();
    for (const auto& file : files) names.push_back(file.name);
    console.print_json({{"schema", "kith.init/1"},
                        {"folder", folder.string()},
                        {"template", options.template_name},
                        {"files", names}});
    return 0;
  }
  std::string names;
  for (const auto& file : files) names += (names.empty() ? "" : ", ") + file.name;
  const auto enter = folder == "." ? std::string{} : "  cd " + folder.string() + "\n";
  console.print(
      fmt::format("wrote {} in {}; try\n{}  kith validate domain.toml study.toml\n"
                  "  kith curriculum domain.toml\n  kith study study.toml -o results\n",
                  names, folder.string(), enter));
  return 0;
}

}  // namespace kith::cli
