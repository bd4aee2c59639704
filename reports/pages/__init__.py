"""The pages of a report: the first, claim by claim, benches; and what other programs and seeded mistakes say."""
