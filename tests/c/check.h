/* check.h - the test harness: every check that fails prints its name, what was expected and what was got. */
#ifndef CHECK_H
#define CHECK_H

/* |got - expected| <= tolerance; NaN fails. */
#define CHECK_CLOSE(name, got, expected, tolerance)                                                \
    check_close(__FILE__, __LINE__, name, got, expected, tolerance)

/* got <= limit; NaN fails. The figure is printed whether it holds or not. */
#define CHECK_BELOW(name, got, limit) check_below(__FILE__, __LINE__, name, got, limit)

/* Whole numbers and truth values. */
#define CHECK_EQUAL(name, got, expected)                                                           \
    check_equal(__FILE__, __LINE__, name, (long long)(got), (long long)(expected))

void check_close(const char *file, int line, const char *name, double got, double expected,
                 double tolerance);
void check_below(const char *file, int line, const char *name, double got, double limit);
void check_equal(const char *file, int line, const char *name, long long got, long long expected);

/* What main returns: 0 when every check held. */
int check_result(void);

#endif
