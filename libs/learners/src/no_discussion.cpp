#include "kith/learners/discussion.hpp"

namespace kith::detail {

DiscussionModel no_discussion() { return {"none", "members do not see each other's answers", {}, nullptr}; }

}  // namespace kith::detail
