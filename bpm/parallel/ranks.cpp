// SPDX-License-Identifier: GPL-3.0-or-later
#include "bpm/parallel/ranks.h"

#include <algorithm>
#include <limits>
#include <mpi.h>
#include <numeric>

namespace boba {

namespace {

/// How many items each rank has and where its first one goes. MPI counts with an int.
struct Parts {
  explicit Parts(std::span<const std::int64_t> counts) {
    std::int64_t total = 0;
    for (const std::int64_t count : counts) {
      if (count > std::numeric_limits<int>::max() - total) {
        throw std::length_error("more than 2^31 values to be shared between the ranks");
      }
      n.push_back(static_cast<int>(count));
      starts.push_back(static_cast<int>(total));
      total += count;
    }
  }
  std::vector<int> n, starts;
};

/// So many bytes as one item.
struct ItemType {
  explicit ItemType(std::size_t bytes) {
    MPI_Type_contiguous(static_cast<int>(bytes), MPI_BYTE, &type);
    MPI_Type_commit(&type);
  }
  ItemType(const ItemType&) = delete;
  ItemType& operator=(const ItemType&) = delete;
  ~ItemType() { MPI_Type_free(&type); }
  MPI_Datatype type = MPI_DATATYPE_NULL;
};

} // namespace

const Ranks& Ranks::alone() {
  static const Ranks one(0, 1);
  return one;
}

Ranks Ranks::of_world() {
  int rank = 0, size = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return Ranks(rank, size);
}

void Ranks::largest(std::span<double> values) const {
  if (is_distributed()) {
    MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  }
}

std::int64_t Ranks::sum(std::int64_t value) const {
  if (is_distributed()) {
    MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_INT64_T, MPI_SUM, MPI_COMM_WORLD);
  }
  return value;
}

void Ranks::broadcast_bytes(void* values, std::size_t bytes) const {
  constexpr std::size_t most = std::numeric_limits<int>::max() / 2; // MPI counts with an int
  for (std::size_t done = 0; done < bytes; done += most) {
    MPI_Bcast(static_cast<char*>(values) + done, static_cast<int>(std::min(most, bytes - done)), MPI_BYTE, 0,
              MPI_COMM_WORLD);
  }
}

void Ranks::any(std::span<char> flags) const {
  if (is_distributed()) {
    MPI_Allreduce(MPI_IN_PLACE, flags.data(), static_cast<int>(flags.size()), MPI_BYTE, MPI_BOR, MPI_COMM_WORLD);
  }
}

std::vector<std::int64_t> Ranks::counts_of_ranks(std::int64_t own) const {
  std::vector<std::int64_t> counts(size_);
  MPI_Allgather(&own, 1, MPI_INT64_T, counts.data(), 1, MPI_INT64_T, MPI_COMM_WORLD);
  return counts;
}

void Ranks::gather(const void* own, void* all, std::span<const std::int64_t> counts, std::size_t item_bytes) const {
  const Parts parts(counts);
  const ItemType item(item_bytes);
  MPI_Gatherv(own, parts.n[rank_], item.type, all, parts.n.data(), parts.starts.data(), item.type, 0, MPI_COMM_WORLD);
}

void Ranks::gather_all(const void* own, void* all, std::span<const std::int64_t> counts, std::size_t item_bytes) const {
  const Parts parts(counts);
  const ItemType item(item_bytes);
  MPI_Allgatherv(own, parts.n[rank_], item.type, all, parts.n.data(), parts.starts.data(), item.type, MPI_COMM_WORLD);
}

void Ranks::share_rows(std::span<double> table, int width, const Ownership& ownership) const {
  if (!is_distributed()) {
    return;
  }
  std::vector<int> counts(size_), starts(size_);
  for (int r = 0, start = 0; r < size_; start += counts[r++]) {
    counts[r] = width * static_cast<int>(ownership.grains_of(r).size());
    starts[r] = start;
  }
  std::vector<double> mine, all(table.size());
  for (const int grain : ownership.grains_of(rank_)) {
    mine.insert(mine.end(), table.begin() + static_cast<std::ptrdiff_t>(grain) * width,
                table.begin() + static_cast<std::ptrdiff_t>(grain + 1) * width);
  }
  MPI_Allgatherv(mine.data(), counts[rank_], MPI_DOUBLE, all.data(), counts.data(), starts.data(), MPI_DOUBLE,
                 MPI_COMM_WORLD);
  for (int r = 0; r < size_; ++r) {
    auto from = all.begin() + starts[r];
    for (const int grain : ownership.grains_of(r)) {
      std::copy_n(from, width, table.begin() + static_cast<std::ptrdiff_t>(grain) * width);
      from += width;
    }
  }
}

void Ranks::agree(const Failure& failure) const {
  const int mine = failure.failed ? rank_ : size_;
  int first = size_;
  MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
  if (first == size_) {
    return;
  }
  std::uint64_t head[2] = {failure.message.size(), failure.wrong_input ? 1U : 0U};
  MPI_Bcast(head, 2, MPI_UINT64_T, first, MPI_COMM_WORLD);
  std::string message = failure.message;
  message.resize(head[0]);
  MPI_Bcast(message.data(), static_cast<int>(head[0]), MPI_BYTE, first, MPI_COMM_WORLD);
  throw RankError(first, head[1] != 0, message);
}

} // namespace boba
