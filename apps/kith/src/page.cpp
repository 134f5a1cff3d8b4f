#include "page.hpp"

#include "kith/core/error.hpp"
#include "kith/report/report.hpp"

namespace kith::cli {

std::string page_with(const std::string& document, std::string_view page) {
  if (page.empty()) {
    throw Error{ErrorKind::kInfeasible, "this program was built without pages for browsers",
                "install Node.js and npm and build it again, or use --json"};
  }
  return render_report(document, page);
}

}  // namespace kith::cli
