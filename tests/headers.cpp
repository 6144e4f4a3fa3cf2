// SPDX-License-Identifier: Apache-2.0
// Holds the tests' precompiled headers (CMakeLists.txt); it has nothing of its own.
