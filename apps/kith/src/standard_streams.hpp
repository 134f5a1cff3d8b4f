#pragma once

namespace kith::cli {

/// Fills descriptors 0, 1 and 2 where the program was started without them (`kith ... 2>&-`), with something that can
/// be neither read nor written: else the next file that is opened would take the number, and messages would be written
/// into it. Call first.
void reserve_standard_descriptors() noexcept;

}  // namespace kith::cli
