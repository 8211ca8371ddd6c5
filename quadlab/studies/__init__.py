"""Many trials, plans or benchmarks that belong together: what varies, what is searched for, what is kept."""
