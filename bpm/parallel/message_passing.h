// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bpm/parallel/ranks.h"

namespace boba {

/// MPI for the life of this object, if the program was started by mpirun or srun; otherwise nothing is started.
class MessagePassing {
public:
  MessagePassing();
  ~MessagePassing();
  MessagePassing(const MessagePassing&) = delete;
  MessagePassing& operator=(const MessagePassing&) = delete;

  const Ranks& ranks() const { return ranks_; }
  /// Ends all ranks at once, from one that cannot go on while the others do not know of it.
  [[noreturn]] void abort(int exit_code) const;

private:
  bool started_ = false;
  Ranks ranks_ = Ranks::alone();
};

/// Threads that a rank may use when nobody says how many: the cores it is bound to, or its share of the machine's.
int threads_of_a_rank(const Ranks& ranks);

} // namespace boba
