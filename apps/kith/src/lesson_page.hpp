#pragma once

#include <string_view>

namespace kith::detail {

// The page that shows a curriculum, made from web/ and embedded when kith was built.
extern const std::string_view kLessonPage;

}  // namespace kith::detail
