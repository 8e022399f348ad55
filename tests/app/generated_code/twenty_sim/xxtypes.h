/* clang-format off */
/* Written by hand in the shape of what 20-sim generates for a submodel: its manual, "C-code generation". */
#ifndef XX_TYPES_H
#define XX_TYPES_H

typedef double XXDouble;
typedef int XXInteger;
typedef char *XXString;

#endif
