#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kith/domains/grey_image.hpp"
#include "kith/domains/named_files.hpp"

namespace kith::detail {

enum class Occupancy : unsigned char { kFree, kOccupied, kUnknown };

// An occupancy grid, top row first.
struct OccupancyGrid {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<Occupancy> pixels;  // shape [height, width]
};

// A value of a flat YAML table.
struct YamlValue {
  std::vector<std::string> scalars;  // one, or those of a list
  bool is_list = false;
  std::size_t offset = 0, key_offset = 0;  // in bytes: its own, and that of its key
};
using YamlTable = std::map<std::string, YamlValue>;
// Nothing after reporting what is wrong (E0268). The engine of pages has one that reads JSON instead, which is YAML.
[[nodiscard]] std::optional<YamlTable> read_yaml_table(const ModelText& file, ModelReport& report);

// Reads an occupancy grid as ROS's map_server writes it: a YAML file that names an image and says how grey becomes
// occupancy (`negate`, `occupied_thresh`, `free_thresh`). A pixel's probability of being occupied is
// (white - grey) / white, or grey / white with `negate`; it is occupied above occupied_thresh, free below free_thresh,
// and otherwise unknown. Nothing after reporting what is wrong (E0268, and what read_pgm and NamedFiles report).
// @param place  where the domain file names the YAML file.
[[nodiscard]] std::optional<OccupancyGrid> read_occupancy_grid(const ModelText& yaml, const TomlPlace& place,
                                                               NamedFiles& files, ModelReport& report);

}  // namespace kith::detail
