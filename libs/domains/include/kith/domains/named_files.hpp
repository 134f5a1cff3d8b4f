#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "kith/domains/domain_files.hpp"
#include "kith/domains/model_text.hpp"
#include "kith/files/reader.hpp"

namespace kith::detail {

// Files of one kind that a domain file may name.
struct FileKind {
  std::string_view what;                  // "a file of a model"
  std::vector<std::string_view> endings;  // ".csv"
};

// The files of an explicit model, of images, and of occupancy grids.
[[nodiscard]] const FileKind& model_files();
[[nodiscard]] const FileKind& image_files();
[[nodiscard]] const FileKind& occupancy_files();

// Opens the files that a domain file names, each once.
class NamedFiles {
 public:
  NamedFiles(const DomainFiles& files, TomlReport& report) : files_{files}, report_{report} {}

  // The text of the file, which lives as long as this object; nothing after reporting at `place` why there is none.
  [[nodiscard]] const ModelText* open(const std::string& name, const TomlPlace& place, const FileKind& kind);

  // What has been read, for those who keep copies. Images are text in these: journals and JSON hold no bytes.
  [[nodiscard]] std::vector<DomainFile> take_read();

 private:
  [[nodiscard]] bool check_name(const std::string& name, const TomlPlace& place, const FileKind& kind);
  [[nodiscard]] std::optional<std::string> text_of(const std::string& name, const TomlPlace& place);

  const DomainFiles& files_;
  TomlReport& report_;
  std::vector<std::unique_ptr<ModelText>> opened_;
  std::vector<DomainFile> read_;
};

}  // namespace kith::detail
