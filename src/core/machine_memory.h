#pragma once

namespace ebru {

/// Bytes of main memory that this machine has, whoever uses them.
double machineMemory();

}  // namespace ebru
