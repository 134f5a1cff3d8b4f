#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "command.hpp"
#include "input.hpp"
#include "kith/domains/domain_file.hpp"
#include "kith/domains/export_model.hpp"
#include "kith/files/atomic_file.hpp"
#include "kith/files/file_set.hpp"
#include "page.hpp"

namespace kith::cli {
namespace {

struct ExportOptions {
  std::string domain;
  std::string format;  ///< One of model_format_names().
  std::string mdp;     ///< Needed where the domain has several.
  std::string out;     ///< A file, or with "prism" what the names of all files begin with; "-": stdout.
  bool yes = false;    ///< Replace files that are there.
};

namespace fs = std::filesystem;

MdpIndex mdp_of(const Domain& domain, const ExportOptions& options) {
  if (options.mdp.empty() && domain.num_mdps() > 1) {
    refuse(fmt::format("the domain has {} worlds; say which one with --mdp N, 0 to {}", domain.num_mdps(),
                       domain.num_mdps() - 1));
  }
  return options.mdp.empty() ? MdpIndex{0} : mdp_called(domain, options.mdp);
}

void declare(OptionList& list, ExportOptions& options) {
  list.domain(options.domain).required();
  list.word("--to", options.format, "FORMAT", model_format_names(), "The format").required();
  list.text("--mdp", options.mdp, "MDP", "Number or name of the world (default: the only one)");
  list.text("-o,--out", options.out, "FILE",
            "File to write (default: '-', stdout), or with prism what the names of all files begin with");
  list.flag("--yes", options.yes, "Replace existing files");
}

int run(const ExportOptions& options, Console& console) {
  const Domain domain = load_domain(options.domain);
  const MdpIndex m = mdp_of(domain, options);
  const auto& names = model_format_names();
  const auto format = static_cast<ModelFormat>(std::find(names.begin(), names.end(), options.format) - names.begin());
  const bool to_stdout = options.out.empty() || options.out == "-";
  if (to_stdout && format == ModelFormat::kPrism)
    refuse("PRISM's format is several files; say what their names begin with: -o PREFIX");
  const fs::path out{to_stdout ? domain.id() + ".json" : options.out};
  if (out.filename().empty()) refuse("-o names a folder; add the name of the file");
  std::error_code ignored;
  if (out.has_parent_path() && !fs::is_directory(out.parent_path(), ignored))
    refuse("there is no folder " + out.parent_path().string() + "; make it first");
  const auto files = export_mdp(domain, m, format, out.filename().string());
  if (to_stdout) {
    console.print(files.front().text);
    return 0;
  }
  for (const auto& file : files) require_replaceable(out.parent_path() / file.name, options.yes);
  if (files.size() == 1) {
    write_file_atomically(out.parent_path() / files.front().name, files.front().text);
  } else {
    FileSet set{out.has_parent_path() ? out.parent_path() : "."};
    for (const auto& file : files) set.write(file.name, file.text);
    set.commit();
  }
  if (console.quiet()) return 0;
  for (const auto& file : files) console.print("wrote " + (out.parent_path() / file.name).string() + "\n");
  return 0;
}

}  // namespace

void add_export(Commands& commands) {
  commands.add<ExportOptions>("export", "Write an MDP of a domain in the format of another program",
                              {"kith export item-delivery --mdp 63 --to gym-json -o delivery.json",
                               "kith export my-domain.toml --to prism -o models/my-domain"},
                              declare, run);
}

}  // namespace kith::cli
