#pragma once

#include <gtest/gtest.h>

/// That a text holds another one.
#define EXPECT_CONTAINS(text, part) \
  EXPECT_NE((text).find(part), std::string::npos) << "in: " << (text) << "\nno: " << (part)
