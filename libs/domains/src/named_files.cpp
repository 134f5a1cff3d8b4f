#include "kith/domains/named_files.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "kith/core/text.hpp"
#include "kith/domains/grey_image.hpp"
#include "kith/domains/model_formats.hpp"

namespace kith::detail {
namespace {

namespace fs = std::filesystem;

}  // namespace

const FileKind& model_files() {
  static const FileKind kKind{"a file of a model", {".csv"}};
  return kKind;
}

const FileKind& image_files() {
  static const FileKind kKind{"an image", {".pgm"}};
  return kKind;
}

const FileKind& occupancy_files() {
  static const FileKind kKind{"an occupancy grid", {".yaml", ".yml"}};
  return kKind;
}

const ModelText* NamedFiles::open(const std::string& name, const TomlPlace& place, const FileKind& kind) {
  if (!check_name(name, place, kind)) return nullptr;
  for (const auto& known : opened_) {
    if (known->name == name) return known.get();
  }
  auto text = text_of(name, place);
  if (!text) return nullptr;
  if (text->starts_with("\xEF\xBB\xBF")) text->erase(0, 3);  // a byte order mark
  if (text->starts_with("\xFF\xFE") || text->starts_with("\xFE\xFF")) {
    report_.error("E0233", place, "the file '" + name + "' is UTF-16", "save it as UTF-8");
    return nullptr;
  }
  read_.push_back({name, *text});
  opened_.push_back(std::make_unique<ModelText>(ModelText{name, (files_.folder / name).string(), *std::move(text)}));
  return opened_.back().get();
}

std::vector<DomainFile> NamedFiles::take_read() {
  for (DomainFile& file : read_) {
    if (!is_image_file(file.name) || !file.text.starts_with("P5")) continue;
    const ModelText text{file.name, file.name, std::move(file.text)};
    ModelReport ignored;  // what is wrong with it has been said
    const auto image = read_pgm(text, ignored);
    file.text = image ? plain_pgm(*image) : "";
  }
  return std::move(read_);
}

// A study keeps copies of all files beside that of the domain file, so they lie there or below. What is wrong with a
// file is shown with its lines, and whoever runs a study need not have written it: only files that look like the data
// of domains are opened, so that none can be made to show others.
bool NamedFiles::check_name(const std::string& name, const TomlPlace& place, const FileKind& kind) {
  const fs::path path{name};
  const auto is_hidden = [](const fs::path& part) { return part.native().starts_with('.') && part != "."; };
  const bool lies_below =
      !name.empty() && path.is_relative() && std::none_of(path.begin(), path.end(), is_hidden);  // ".." is hidden, too
  const bool is_plain =
      std::none_of(name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; });
  const std::string refusal = "'" + name + "' cannot be " + std::string{kind.what};
  if (!lies_below || !is_plain) {
    report_.error("E0232", place, refusal,
                  "give a path relative to the domain file, to a file in its folder or below that is not hidden");
    return false;
  }
  const auto& endings = kind.endings;
  const std::string ending = is_image_file(name) ? ".pgm" : path.extension().string();
  if (std::find(endings.begin(), endings.end(), ending) != endings.end()) return true;
  report_.error("E0232", place, refusal, "its name ends in " + listed(endings, {}, " or "));
  return false;
}

std::optional<std::string> NamedFiles::text_of(const std::string& name, const TomlPlace& place) {
  for (const DomainFile& known : files_.known) {
    if (known.name == name) return known.text;
  }
  const fs::path path = files_.folder / name;
  std::error_code failure;
  std::string text;
  std::ifstream in;
  if (fs::is_regular_file(path, failure)) in.open(path, std::ios::binary);
  const auto size = in.is_open() ? fs::file_size(path, failure) : 0;
  if (!failure && size > kMaxModelBytes) {
    report_.error("E0233", place, "the file '" + name + "' is larger than 64 MiB",
                  "leave out what the robot cannot reach, or split it into several domains");
    return std::nullopt;
  }
  text.resize(size);
  if (in.is_open()) in.read(text.data(), static_cast<std::streamsize>(size));
  if (in.is_open() && !in.bad()) {
    text.resize(static_cast<std::size_t>(in.gcount()));
    return text;
  }
  report_.error("E0233", place, "the file '" + name + "' cannot be read", "it is expected at " + path.string());
  return std::nullopt;
}

}  // namespace kith::detail
