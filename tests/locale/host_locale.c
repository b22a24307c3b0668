/* host_locale.c - loaded before a program (LD_PRELOAD), it does what a host program may do: it takes the locale of the
 * environment, with that locale's decimal point. */
#include <locale.h>

__attribute__((constructor)) static void take_locale(void)
{
    setlocale(LC_ALL, "");
}
