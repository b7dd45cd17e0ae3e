// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/packing/snapshot.h"

#include <functional>
#include <future>

namespace boba {

/// Hands frames to a writer on a thread of its own, one at a time and in their order. The run meanwhile goes on; it
/// waits for a frame only when the next one comes, or when somebody wants to rely on it.
///
/// For writers that call neither HDF5 (which the run calls too) nor MPI.
class WriteBehind {
public:
  using Write = std::function<void(const Snapshot&)>;
  explicit WriteBehind(Write write) : write_(std::move(write)) {}
  WriteBehind(const WriteBehind&) = delete;
  WriteBehind& operator=(const WriteBehind&) = delete;
  /// Waits; what went wrong since the last `wait` is then not heard of.
  ~WriteBehind() = default;

  /// \throws what the writer threw for the frame before.
  void add(Snapshot&& frame);
  /// Returns when all frames are written. \throws what the writer threw.
  void wait();

private:
  Write write_;
  std::future<void> written_; ///< of the frame that is being written; its end is waited for when this goes away
};

} // namespace boba
