#include <fmt/format.h>
#include <fmt/ranges.h>

#include <filesystem>

#include "command.hpp"
#include "embedded.hpp"
#include "input.hpp"
#include "kith/files/file_set.hpp"

namespace kith::cli {
namespace {

struct InitOptions {
  std::string folder = ".";
  std::string template_name = "item-delivery";
  bool trials = false;  ///< An example of people's answers, for `kith fit`, and nothing else.
};

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

void declare(OptionList& list, InitOptions& options) {
  list.text("folder", options.folder, "DIR", "Where to write them");
  list.word("--template", options.template_name, "NAME", {"item-delivery", "blank", "human-study"},
            "What to start from");
  list.flag("--trials", options.trials, "Write trials.csv instead: people's answers as kith fit reads them");
}

int run(const InitOptions& options, Console& console) {
  const std::filesystem::path folder{options.folder};
  const auto files = options.trials ? std::vector<NewFile>{{"trials.csv", std::string{detail::kTrialsTemplate}}}
                                    : files_of(options.template_name);
  // Everything or nothing: what people have written is never replaced.
  for (const auto& file : files) {
    std::error_code failure;
    if (std::filesystem::exists(std::filesystem::symlink_status(folder / file.name, failure))) {
      refuse((folder / file.name).string() + " exists already; name another folder");
    }
  }
  FileSet set{folder};
  for (const auto& file : files) set.write(file.name, file.content);
  set.commit();

  std::vector<std::string> names;
  for (const auto& file : files) names.push_back(file.name);
  if (options.trials) {
    console.print(fmt::format("wrote {}; try\n  kith fit {} --folds 0\n", (folder / "trials.csv").string(),
                              (folder / "trials.csv").string()));
    return 0;
  }
  const auto enter = folder == "." ? std::string{} : "  cd " + folder.string() + "\n";
  console.print(
      fmt::format("wrote {} in {}; try\n{}  kith validate domain.toml study.toml\n"
                  "  kith lesson domain.toml\n  kith study study.toml -o results\n",
                  fmt::join(names, ", "), folder.string(), enter));
  return 0;
}

}  // namespace

void add_init(Commands& commands) {
  commands.add<InitOptions>("init", "Write a domain, a study and a README to start from",
                            {"kith init my-robot", "kith init my-robot --template blank", "kith init answers --trials"},
                            declare, run);
}

}  // namespace kith::cli
