#pragma once

namespace ebru {

/// Of the program, as the build says it: "0.1.0". Part of every fingerprint.
const char* programVersion();

}  // namespace ebru
