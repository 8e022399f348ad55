/* clang-format off */
/* Written by hand in the shape of what Embedded Coder generates. */
#ifndef RTWTYPES_H
#define RTWTYPES_H

typedef double real_T;
typedef unsigned char boolean_T;

#endif
