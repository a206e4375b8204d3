#include "check.h"

#include <math.h>
#include <stdio.h>

static int failures, checks;

void check_close(const char *file, int line, const char *name, double got, double expected,
                 double tolerance)
{
    checks++;
    if (fabs(got - expected) <= tolerance)
        return;
    failures++;
    printf("%s:%d: FAIL %s: expected %.17g within %.3g, got %.17g\n", file, line, name, expected,
           tolerance, got);
}

void check_below(const char *file, int line, const char *name, double got, double limit)
{
    checks++;
    if (got <= limit) {
        printf("ok   %s: %.3g <= %.3g\n", name, got, limit);
        return;
    }
    failures++;
    printf("%s:%d: FAIL %s: expected at most %.3g, got %.17g\n", file, line, name, limit, got);
}

void check_equal(const char *file, int line, const char *name, long long got, long long expected)
{
    checks++;
    if (got == expected)
        return;
    failures++;
    printf("%s:%d: FAIL %s: expected %lld, got %lld\n", file, line, name, expected, got);
}

int check_result(void)
{
    printf("%d checks, %d failed\n", checks, failures);
    return failures > 0 || checks == 0;
}
