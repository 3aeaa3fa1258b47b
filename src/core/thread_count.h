#pragma once

namespace ebru {

/// How many threads parallel loops may use at the moment: the machine's, or fewer under a ThreadLimit
/// (core/parallel.h). For libraries that bring their own threads. At least 1.
int allowedThreads();

}  // namespace ebru
