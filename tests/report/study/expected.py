"""Every table of two reports, row by row, as people read it."""

# ruff: noqa: E501 - a row stands on a line.

from __future__ import annotations

ONE_STUDY = {
    "headline": """
model | kind | completion | would it repeat? | other tasks? | strict | strict: would it repeat? | strict: other tasks? | pass^k | k | tasks | n | unscored
baseline | rule-based | 0.75 | – | 0.30 to 1.00 | 0.75 | – | 0.30 to 1.00 | 0.75 | 1 | 5 | 20 | 0
openai:gpt-4o | vlm | 0.50 | 0.35 to 0.65 | 0.05 to 0.95 | 0.50 | 0.35 to 0.65 | 0.05 to 0.95 | 0.05 | 3 | 5 | 60 | 0
GPT-4o (paper) | vlm | 0.65 | 0.62 to 0.68 | 0.20 to 1.00 | – | – | – | – | – | 5 | 299 | –
Claude 3.5 Sonnet (paper) | vlm | 0.59 | 0.56 to 0.61 | 0.14 to 1.00 | – | – | – | – | – | 5 | 298 | –
""",
    "comparison": """
measure | second less first | first’s mean | second’s mean | difference | would it repeat? | other tasks? | p | could have seen: same tasks | could have seen: other tasks | tasks | first’s n | second’s n
completion | openai:gpt-4o less baseline | 0.75 | 0.50 | −0.25 | −0.40 to −0.10 | −0.70 to +0.20 | 0.250 | 0.21 | 0.50 | 5 | 20 | 60
strict | openai:gpt-4o less baseline | 0.75 | 0.50 | −0.25 | −0.40 to −0.10 | −0.70 to +0.20 | 0.250 | 0.21 | 0.50 | 5 | 20 | 60
""",
    "comparison-more": """
measure | second less first | first’s mean | second’s mean | difference | would it repeat? | other tasks? | p | could have seen: same tasks | could have seen: other tasks | tasks | first’s n | second’s n
early stops | openai:gpt-4o less baseline | 0.25 | 0.50 | +0.25 | +0.10 to +0.40 | −0.20 to +0.70 | 0.250 | 0.21 | 0.50 | 5 | 20 | 60
false claims | openai:gpt-4o less baseline | 0.25 | 0.50 | +0.25 | +0.10 to +0.40 | −0.20 to +0.70 | 0.250 | 0.21 | 0.50 | 5 | 20 | 60
tool calls | openai:gpt-4o less baseline | 3.00 | 3.00 | 0.00 | 0.00 to 0.00 | 0.00 to 0.00 | 1.000 | 0.00 | 0.00 | 5 | 20 | 60
model calls | openai:gpt-4o less baseline | 4.00 | 4.00 | 0.00 | 0.00 to 0.00 | 0.00 to 0.00 | 1.000 | 0.00 | 0.00 | 5 | 20 | 60
tokens | openai:gpt-4o less baseline | 9,100 | 9,100 | 0 | 0 to 0 | 0 to 0 | 1.000 | 0 | 0 | 5 | 20 | 60
cost, $ | openai:gpt-4o less baseline | $0.0200 | $0.0200 | $0.00 | $0.00 to $0.00 | $0.00 to $0.00 | 1.000 | $0.00 | $0.00 | 5 | 20 | 60
seconds per call | openai:gpt-4o less baseline | 2.00 | 2.00 | 0.00 | 0.00 to 0.00 | 0.00 to 0.00 | 1.000 | 0.00 | 0.00 | 5 | 20 | 60
""",
    "tasks-opaq-s1": """
task | C-D printed | C-D computed | baseline | would it repeat? | openai:gpt-4o | would it repeat? | GPT-4o (paper) | Claude 3.5 Sonnet (paper)
T1 | 1 | 1 | 1.00 | – | 0.33 | 0.00 to 1.00 | 1.00 | 1.00
T3 | 2 | 4 | 0.00 | – | 0.33 | 0.00 to 1.00 | 0.60 | 0.73
T8 | 8 | 8 | 1.00 | – | 0.00 | 0.00 to 0.63 | 0.47 | 0.07
T10 | 11 | 12 | 0.00 | – | 0.33 | 0.00 to 1.00 | 0.07 | 0.10
T14 | 15 | 18 | 1.00 | – | 0.67 | 0.00 to 1.00 | 0.37 | 0.44
""",
    "tasks-opaq-s2": """
task | C-D printed | C-D computed | baseline | would it repeat? | openai:gpt-4o | would it repeat? | GPT-4o (paper) | Claude 3.5 Sonnet (paper)
T1 | 1 | 1 | 1.00 | – | 0.00 | 0.00 to 0.63 | 0.93 | 1.00
T3 | 2 | 4 | 1.00 | – | 0.33 | 0.00 to 1.00 | 0.73 | 0.00
T8 | 8 | 8 | 0.00 | – | 0.33 | 0.00 to 1.00 | 0.77 | 0.47
T10 | 11 | 12 | 1.00 | – | 0.67 | 0.00 to 1.00 | 0.07 | 0.17
T14 | 15 | 18 | 0.00 | – | 0.67 | 0.00 to 1.00 | 0.21 | 0.34
""",
    "tasks-sem-s1": """
task | C-D printed | C-D computed | baseline | would it repeat? | openai:gpt-4o | would it repeat? | GPT-4o (paper) | Claude 3.5 Sonnet (paper)
T1 | 1 | 1 | 1.00 | – | 0.67 | 0.00 to 1.00 | 1.00 | 1.00
T3 | 2 | 4 | 1.00 | – | 0.33 | 0.00 to 1.00 | 1.00 | 0.67
T8 | 8 | 8 | 1.00 | – | 0.67 | 0.00 to 1.00 | 1.00 | 1.00
T10 | 11 | 12 | 0.00 | – | 0.67 | 0.00 to 1.00 | 1.00 | 1.00
T14 | 15 | 18 | 1.00 | – | 0.67 | 0.00 to 1.00 | 0.31 | 0.36
""",
    "tasks-sem-s2": """
task | C-D printed | C-D computed | baseline | would it repeat? | openai:gpt-4o | would it repeat? | GPT-4o (paper) | Claude 3.5 Sonnet (paper)
T1 | 1 | 1 | 1.00 | – | 0.33 | 0.00 to 1.00 | 1.00 | 1.00
T3 | 2 | 4 | 1.00 | – | 0.67 | 0.00 to 1.00 | 0.29 | 0.00
T8 | 8 | 8 | 1.00 | – | 0.67 | 0.00 to 1.00 | 1.00 | 1.00
T10 | 11 | 12 | 1.00 | – | 0.67 | 0.00 to 1.00 | 0.97 | 1.00
T14 | 15 | 18 | 1.00 | – | 1.00 | 0.37 to 1.00 | 0.21 | 0.37
""",
    "averages": """
cells | model | completion | would it repeat? | other tasks? | s/call | Walk | Look | Look + first | Pick | Drop | Total | n
all labelings | baseline | 0.75 | – | 0.30 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 20
all labelings | openai:gpt-4o | 0.50 | 0.35 to 0.65 | 0.05 to 0.95 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 60
all labelings | GPT-4o (paper), published | 0.65 | 0.62 to 0.68 | 0.20 to 1.00 | 7.67 | 0.74 | 0.87 | 1.87 | 2.06 | 1.50 | 5.17 | 299
all labelings | Claude 3.5 Sonnet (paper), published | 0.59 | 0.56 to 0.61 | 0.14 to 1.00 | 7.95 | 0.33 | 0.87 | 1.87 | 1.81 | 1.39 | 4.40 | 298
all labelings | GPT-4o (paper), printed | 0.68 | – | – | 6.85 | – | – | – | – | – | 4.70 | –
all labelings | Claude 3.5 Sonnet (paper), printed | 0.61 | – | – | 8.01 | – | – | – | – | – | 4.19 | –
OPAQ | baseline | 0.60 | – | 0.15 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 10
OPAQ | openai:gpt-4o | 0.37 | 0.16 to 0.57 | 0.00 to 0.82 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 30
OPAQ | GPT-4o (paper), published | 0.52 | 0.47 to 0.57 | 0.07 to 0.97 | 8.48 | 0.71 | 0.92 | 1.92 | 1.99 | 1.43 | 5.05 | 150
OPAQ | Claude 3.5 Sonnet (paper), published | 0.43 | 0.39 to 0.47 | 0.00 to 0.88 | 8.13 | 0.38 | 1.29 | 2.29 | 1.76 | 1.37 | 4.80 | 149
OPAQ | GPT-4o (paper), printed | 0.48 | – | – | 7.63 | 0.53 | – | 1.61 | – | – | 4.80 | –
OPAQ | Claude 3.5 Sonnet (paper), printed | 0.38 | – | – | 8.31 | 0.38 | – | 2.10 | – | – | 4.57 | –
SEM | baseline | 0.90 | – | 0.45 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 10
SEM | openai:gpt-4o | 0.63 | 0.42 to 0.85 | 0.18 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 30
SEM | GPT-4o (paper), published | 0.78 | 0.75 to 0.81 | 0.33 to 1.00 | 6.86 | 0.78 | 0.83 | 1.83 | 2.13 | 1.56 | 5.29 | 149
SEM | Claude 3.5 Sonnet (paper), published | 0.74 | 0.71 to 0.77 | 0.29 to 1.00 | 7.77 | 0.28 | 0.46 | 1.46 | 1.85 | 1.40 | 3.99 | 149
SEM | GPT-4o (paper), printed | 0.88 | – | – | 6.06 | 0.62 | – | 1.41 | – | – | 4.60 | –
SEM | Claude 3.5 Sonnet (paper), printed | 0.83 | – | – | 7.72 | 0.23 | – | 1.25 | – | – | 3.80 | –
OPAQ, S1 | baseline | 0.60 | – | 0.00 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 5
OPAQ, S1 | openai:gpt-4o | 0.33 | 0.03 to 0.64 | 0.00 to 0.78 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 15
OPAQ, S1 | GPT-4o (paper), published | 0.50 | 0.44 to 0.56 | 0.05 to 0.95 | 5.56 | 0.01 | 0.35 | 1.35 | 1.96 | 1.51 | 3.83 | 75
OPAQ, S1 | Claude 3.5 Sonnet (paper), published | 0.47 | 0.40 to 0.53 | 0.00 to 0.97 | 8.18 | 0.40 | 1.21 | 2.21 | 1.85 | 1.47 | 4.93 | 75
OPAQ, S2 | baseline | 0.60 | – | 0.00 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 5
OPAQ, S2 | openai:gpt-4o | 0.40 | 0.09 to 0.71 | 0.00 to 0.85 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 15
OPAQ, S2 | GPT-4o (paper), published | 0.54 | 0.47 to 0.62 | 0.07 to 1.00 | 11.40 | 1.40 | 1.49 | 2.49 | 2.03 | 1.36 | 6.28 | 75
OPAQ, S2 | Claude 3.5 Sonnet (paper), published | 0.40 | 0.34 to 0.45 | 0.00 to 0.87 | 8.08 | 0.36 | 1.36 | 2.36 | 1.67 | 1.28 | 4.67 | 74
SEM, S1 | baseline | 0.80 | – | 0.24 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 5
SEM, S1 | openai:gpt-4o | 0.60 | 0.27 to 0.93 | 0.15 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 15
SEM, S1 | GPT-4o (paper), published | 0.86 | 0.82 to 0.90 | 0.41 to 1.00 | 5.00 | 0.00 | 0.17 | 1.17 | 2.09 | 1.67 | 3.93 | 75
SEM, S1 | Claude 3.5 Sonnet (paper), published | 0.81 | 0.75 to 0.87 | 0.35 to 1.00 | 7.99 | 0.23 | 0.40 | 1.40 | 1.83 | 1.43 | 3.88 | 75
SEM, S1 | GPT-4o (paper), printed | 0.93 | – | – | 4.71 | 0.00 | – | 1.08 | – | – | 3.67 | –
SEM, S1 | Claude 3.5 Sonnet (paper), printed | 0.90 | – | – | 7.94 | 0.19 | – | 1.19 | – | – | 3.75 | –
SEM, S2 | baseline | 1.00 | – | 0.55 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 5
SEM, S2 | openai:gpt-4o | 0.67 | 0.36 to 0.97 | 0.22 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 15
SEM, S2 | GPT-4o (paper), published | 0.69 | 0.63 to 0.75 | 0.19 to 1.00 | 8.72 | 1.56 | 1.48 | 2.48 | 2.16 | 1.45 | 6.65 | 74
SEM, S2 | Claude 3.5 Sonnet (paper), published | 0.67 | 0.63 to 0.71 | 0.10 to 1.00 | 7.54 | 0.33 | 0.52 | 1.52 | 1.88 | 1.37 | 4.10 | 74
SEM, S2 | GPT-4o (paper), printed | 0.83 | – | – | 7.12 | 1.24 | – | 1.74 | – | – | 5.53 | –
SEM, S2 | Claude 3.5 Sonnet (paper), printed | 0.76 | – | – | 7.49 | 0.28 | – | 1.30 | – | – | 5.89 | –
""",
    "families": """
family | model | completion | would it repeat? | other tasks? | strict | model calls | tokens | n
single object | baseline | 0.88 | – | 0.00 to 1.00 | 0.88 | 4.00 | 9,100 | 8
single object | openai:gpt-4o | 0.38 | 0.14 to 0.61 | 0.00 to 1.00 | 0.38 | 4.00 | 9,100 | 24
single object | GPT-4o (paper) | 0.82 | 0.76 to 0.88 | 0.00 to 1.00 | – | 4.31 | 35,924 | 119
single object | Claude 3.5 Sonnet (paper) | 0.68 | 0.63 to 0.72 | 0.00 to 1.00 | – | 2.89 | 20,811 | 119
several objects | baseline | 0.75 | – | – | 0.75 | 4.00 | 9,100 | 4
several objects | openai:gpt-4o | 0.42 | 0.06 to 0.77 | – | 0.42 | 4.00 | 9,100 | 12
several objects | GPT-4o (paper) | 0.81 | 0.76 to 0.86 | – | – | 5.63 | 39,736 | 60
several objects | Claude 3.5 Sonnet (paper) | 0.63 | 0.57 to 0.69 | – | – | 5.50 | 40,866 | 60
comparative and relational | baseline | 0.50 | – | – | 0.50 | 4.00 | 9,100 | 4
comparative and relational | openai:gpt-4o | 0.58 | 0.20 to 0.97 | – | 0.58 | 4.00 | 9,100 | 12
comparative and relational | GPT-4o (paper) | 0.53 | 0.48 to 0.57 | – | – | 6.02 | 45,029 | 60
comparative and relational | Claude 3.5 Sonnet (paper) | 0.57 | 0.52 to 0.62 | – | – | 5.88 | 45,602 | 60
attribute-heavy and long | baseline | 0.75 | – | – | 0.75 | 4.00 | 9,100 | 4
attribute-heavy and long | openai:gpt-4o | 0.75 | 0.40 to 1.00 | – | 0.75 | 4.00 | 9,100 | 12
attribute-heavy and long | GPT-4o (paper) | 0.28 | 0.23 to 0.33 | – | – | 10.32 | 103,507 | 60
attribute-heavy and long | Claude 3.5 Sonnet (paper) | 0.38 | 0.32 to 0.44 | – | – | 9.77 | 93,032 | 59
""",
    "labelings": """
model | OPAQ | SEM | difference | would it repeat? | other tasks? | p | gain | Looks
baseline | 0.60 | 0.90 | +0.30 | – | −0.15 to +0.75 | 0.250 | +50.0 % | 0.0 %
openai:gpt-4o | 0.37 | 0.63 | +0.27 | −0.03 to +0.56 | −0.18 to +0.72 | 0.062 | +72.7 % | 0.0 %
GPT-4o (paper), printed | 0.48 | 0.88 | +0.40 | – | – | – | +83.3 % | −12.4 %
Claude 3.5 Sonnet (paper), printed | 0.38 | 0.83 | +0.45 | – | – | – | +118.4 % | −40.5 %
""",
    "spearman": """
model | labeling | ρ: printed, tasks | p: printed, tasks | ρ: printed, cells | p: printed, cells | ρ: computed, tasks | p: computed, tasks | ρ: computed, cells | p: computed, cells | tasks | cells
baseline | all | −0.67 | 0.215 | −0.24 | 0.298 | −0.67 | 0.215 | −0.24 | 0.298 | 5 | 20
baseline | OPAQ | −0.71 | 0.182 | −0.29 | 0.419 | −0.71 | 0.182 | −0.29 | 0.419 | 5 | 10
baseline | SEM | −0.35 | 0.559 | −0.24 | 0.512 | −0.35 | 0.559 | −0.24 | 0.512 | 5 | 10
openai:gpt-4o | all | 0.97 | 0.005 | 0.59 | 0.006 | 0.97 | 0.005 | 0.59 | 0.006 | 5 | 20
openai:gpt-4o | OPAQ | 0.82 | 0.089 | 0.72 | 0.018 | 0.82 | 0.089 | 0.72 | 0.018 | 5 | 10
openai:gpt-4o | SEM | 0.95 | 0.014 | 0.65 | 0.040 | 0.95 | 0.014 | 0.65 | 0.040 | 5 | 10
GPT-4o and Claude 3.5 Sonnet (paper), published | all | −0.70 | 0.188 | −0.47 | 0.002 | −0.70 | 0.188 | −0.47 | 0.002 | 5 | 40
GPT-4o and Claude 3.5 Sonnet (paper), published | OPAQ | −0.90 | 0.037 | −0.65 | 0.002 | −0.90 | 0.037 | −0.65 | 0.002 | 5 | 20
GPT-4o and Claude 3.5 Sonnet (paper), published | SEM | −0.62 | 0.269 | −0.39 | 0.091 | −0.62 | 0.269 | −0.39 | 0.091 | 5 | 20
the paper, printed | SEM | −0.53 | < 0.05 | – | – | – | – | – | – | – | –
""",
    "failure-classes": """
labeling | model | scored | failed | perceptual | execution | reasoning | protocol (count) | undiagnosed (count)
OPAQ | baseline | 10 | 4 | 50.0 % | 25.0 % | 25.0 % | 0 | 0
OPAQ | openai:gpt-4o | 30 | 19 | 22.2 % | 44.4 % | 33.3 % | 1 | 0
OPAQ | both models (paper), printed | – | – | 83.5 % | 14.2 % | – | – | –
SEM | baseline | 10 | 1 | – | – | – | 1 | 0
SEM | openai:gpt-4o | 30 | 11 | 0.0 % | 25.0 % | 75.0 % | 3 | 0
SEM | both models (paper), printed | – | – | 65.8 % | 31.1 % | – | – | –
""",
    "failure-codes-rule-based": """
class | code | what it means | OPAQ | SEM | all | share
perceptual | wrong object | Another object was taken in place of the one that was asked for. | 2 | 0 | 2 | 40.0 %
execution | false claim | The agent ended too early and said that all was done. | 1 | 0 | 1 | 20.0 %
reasoning | goal forgotten | A part of the instruction was never named nor tried. | 1 | 0 | 1 | 20.0 %
protocol | unreadable | Replies could not be read as a call or an answer. | 0 | 1 | 1 | 20.0 %
""",
    "failure-codes-vlm": """
class | code | what it means | OPAQ | SEM | all | share
perceptual | wrong object | Another object was taken in place of the one that was asked for. | 4 | 0 | 4 | 13.3 %
execution | false claim | The agent ended too early and said that all was done. | 8 | 2 | 10 | 33.3 %
reasoning | goal forgotten | A part of the instruction was never named nor tried. | 6 | 6 | 12 | 40.0 %
protocol | unreadable | Replies could not be read as a call or an answer. | 1 | 3 | 4 | 13.3 %
""",
    "calls": """
labeling | model | Walk | Look | Pick | Drop | all tools | model calls | requests
all labelings | baseline | 0.00 | 1.00 | 1.00 | 1.00 | 3.00 | 4.00 | 4.00
all labelings | openai:gpt-4o | 0.00 | 1.00 | 1.00 | 1.00 | 3.00 | 4.00 | 4.00
all labelings | GPT-4o (paper) | 0.74 | 0.87 | 2.06 | 1.50 | 5.17 | 6.12 | –
all labelings | Claude 3.5 Sonnet (paper) | 0.33 | 0.87 | 1.81 | 1.39 | 4.40 | 5.39 | –
OPAQ | baseline | 0.00 | 1.00 | 1.00 | 1.00 | 3.00 | 4.00 | 4.00
OPAQ | openai:gpt-4o | 0.00 | 1.00 | 1.00 | 1.00 | 3.00 | 4.00 | 4.00
OPAQ | GPT-4o (paper) | 0.71 | 0.92 | 1.99 | 1.43 | 5.05 | 5.98 | –
OPAQ | Claude 3.5 Sonnet (paper) | 0.38 | 1.29 | 1.76 | 1.37 | 4.80 | 5.80 | –
SEM | baseline | 0.00 | 1.00 | 1.00 | 1.00 | 3.00 | 4.00 | 4.00
SEM | openai:gpt-4o | 0.00 | 1.00 | 1.00 | 1.00 | 3.00 | 4.00 | 4.00
SEM | GPT-4o (paper) | 0.78 | 0.83 | 2.13 | 1.56 | 5.29 | 6.25 | –
SEM | Claude 3.5 Sonnet (paper) | 0.28 | 0.46 | 1.85 | 1.40 | 3.99 | 4.98 | –
""",
    "tokens": """
labeling | model | tokens | in | cached | out | reasoning | tokens per solved | cost | cost per solved | solved
all labelings | baseline | 9,100 | 9,000 | 0 | 100 | 0 | 12,133 | $0.0200 | $0.0267 | 15
all labelings | openai:gpt-4o | 9,100 | 9,000 | 0 | 100 | 0 | 18,200 | $0.0200 | $0.0400 | 30
all labelings | GPT-4o (paper) | 52,024 | 51,678 | – | 345 | – | – | – | – | –
all labelings | Claude 3.5 Sonnet (paper) | 44,224 | 43,594 | – | 630 | – | – | – | – | –
OPAQ | baseline | 9,100 | 9,000 | 0 | 100 | 0 | 15,167 | $0.0200 | $0.0333 | 6
OPAQ | openai:gpt-4o | 9,100 | 9,000 | 0 | 100 | 0 | 24,818 | $0.0200 | $0.0545 | 11
OPAQ | GPT-4o (paper) | 51,615 | 51,251 | – | 364 | – | – | – | – | –
OPAQ | Claude 3.5 Sonnet (paper) | 50,482 | 49,803 | – | 679 | – | – | – | – | –
SEM | baseline | 9,100 | 9,000 | 0 | 100 | 0 | 10,111 | $0.0200 | $0.0222 | 9
SEM | openai:gpt-4o | 9,100 | 9,000 | 0 | 100 | 0 | 14,368 | $0.0200 | $0.0316 | 19
SEM | GPT-4o (paper) | 52,432 | 52,106 | – | 326 | – | – | – | – | –
SEM | Claude 3.5 Sonnet (paper) | 37,966 | 37,385 | – | 581 | – | – | – | – | –
""",
    "time": """
labeling | model | model s/call | model s | world s | waited s
all labelings | baseline | 2.00 | 8.00 | 1.00 | 0.00
all labelings | openai:gpt-4o | 2.00 | 8.00 | 1.00 | 0.00
all labelings | GPT-4o (paper) | 7.67 | 53.80 | – | –
all labelings | Claude 3.5 Sonnet (paper) | 7.95 | 44.54 | – | –
OPAQ | baseline | 2.00 | 8.00 | 1.00 | 0.00
OPAQ | openai:gpt-4o | 2.00 | 8.00 | 1.00 | 0.00
OPAQ | GPT-4o (paper) | 8.48 | 58.56 | – | –
OPAQ | Claude 3.5 Sonnet (paper) | 8.13 | 49.95 | – | –
SEM | baseline | 2.00 | 8.00 | 1.00 | 0.00
SEM | openai:gpt-4o | 2.00 | 8.00 | 1.00 | 0.00
SEM | GPT-4o (paper) | 6.86 | 49.04 | – | –
SEM | Claude 3.5 Sonnet (paper) | 7.77 | 39.13 | – | –
""",
    "conduct": """
labeling | model | completion | strict | early stops | false claims | refused calls | corrected calls | protocol failures | missing notes | cut prompts | walked, m | path / oracle’s
all labelings | baseline | 0.75 | 0.75 | 25.0 % | 25.0 % | 0.00 | 0.00 | 0.00 | 0.00 | 0.00 | 2.00 | 2.00
all labelings | openai:gpt-4o | 0.50 | 0.50 | 50.0 % | 50.0 % | 0.00 | 0.00 | 0.00 | 0.00 | 0.00 | 2.00 | 2.00
all labelings | GPT-4o (paper) | 0.65 | – | – | – | – | – | – | – | – | – | –
all labelings | Claude 3.5 Sonnet (paper) | 0.59 | – | – | – | – | – | – | – | – | – | –
OPAQ | baseline | 0.60 | 0.60 | 40.0 % | 40.0 % | 0.00 | 0.00 | 0.00 | 0.00 | 0.00 | 2.00 | 2.00
OPAQ | openai:gpt-4o | 0.37 | 0.37 | 63.3 % | 63.3 % | 0.00 | 0.00 | 0.00 | 0.00 | 0.00 | 2.00 | 2.00
OPAQ | GPT-4o (paper) | 0.52 | – | – | – | – | – | – | – | – | – | –
OPAQ | Claude 3.5 Sonnet (paper) | 0.43 | – | – | – | – | – | – | – | – | – | –
SEM | baseline | 0.90 | 0.90 | 10.0 % | 10.0 % | 0.00 | 0.00 | 0.00 | 0.00 | 0.00 | 2.00 | 2.00
SEM | openai:gpt-4o | 0.63 | 0.63 | 36.7 % | 36.7 % | 0.00 | 0.00 | 0.00 | 0.00 | 0.00 | 2.00 | 2.00
SEM | GPT-4o (paper) | 0.78 | – | – | – | – | – | – | – | – | – | –
SEM | Claude 3.5 Sonnet (paper) | 0.74 | – | – | – | – | – | – | – | – | – | –
""",
    "prompts": """
task | prompt | family | conditions | ACT | REF | REL | C-D printed | C-D computed
T1 | Pick the object tagged as 34 | single object | 1 | 1 | 0 | 0 | 1 | 1
T3 | Pick the blue circular object | single object | 1 | 1 | 1 | 0 | 2 | 4
T8 | Pick the glass and the plate then put them on the floor | several objects | 2 | 4 | 2 | 2 | 8 | 8
T10 | Pick the glass then place it next to the plate, moreover pick the binoculars and place it next to the screwdriver | comparative and relational | 2 | 4 | 4 | 4 | 11 | 12
T14 | Pick all objects with white parts and place them on the floor | attribute-heavy and long | 5 | 10 | 3 | 5 | 15 | 18
""",
    "taxonomy": """
dimension | unit | what it asks for | level
ACT | pick | pick an object | 1
ACT | drop | release or place an object | 1
REF | id | a number, unique in the scene | 0
REF | tag | a semantic tag or name | 1
REF | attrColor | a colour | 1
REF | attrShape | a shape | 2
REF | groupSimple | a group, filtered by one criterion | 2
REF | attrPattern | a pattern | 3
REF | superExtremum | a superlative: least or most of an attribute | 3
REL | floor | on the floor | 1
REL | prox | near another object | 2
REL | area | within a designated area | 4
""",
}
"""A model with chance and one without, in one study."""

SIDE_BY_SIDE = {
    "headline": """
model | kind | completion | would it repeat? | other tasks? | strict | strict: would it repeat? | strict: other tasks? | pass^k | k | tasks | n | unscored
openai:gpt-4o, k=4 | vlm | 0.67 | 0.44 to 0.90 | 0.04 to 1.00 | 0.67 | 0.44 to 0.90 | 0.04 to 1.00 | 0.50 | 2 | 3 | 24 | 0
openai:gpt-4o, k=50 | vlm | 0.71 | 0.45 to 0.97 | 0.08 to 1.00 | 0.71 | 0.45 to 0.97 | 0.08 to 1.00 | 0.42 | 2 | 3 | 24 | 0
openai:gpt-4o | vlm | 0.42 | 0.17 to 0.67 | 0.00 to 1.00 | 0.42 | 0.17 to 0.67 | 0.00 to 1.00 | 0.17 | 2 | 3 | 24 | 0
GPT-4o (paper) | vlm | 0.69 | 0.66 to 0.71 | 0.00 to 1.00 | – | – | – | – | – | 3 | 180 | –
Claude 3.5 Sonnet (paper) | vlm | 0.67 | 0.64 to 0.70 | 0.00 to 1.00 | – | – | – | – | – | 3 | 179 | –
""",
    "comparison": """
measure | second less first | first’s mean | second’s mean | difference | would it repeat? | other tasks? | p | could have seen: same tasks | could have seen: other tasks | tasks | first’s n | second’s n
completion | openai:gpt-4o, k=50 less openai:gpt-4o, k=4 | 0.67 | 0.71 | +0.04 | −0.34 to +0.43 | −0.59 to +0.67 | 1.000 | 0.51 | 0.63 | 3 | 24 | 24
completion | openai:gpt-4o less openai:gpt-4o, k=4 | 0.67 | 0.42 | −0.25 | −0.62 to +0.12 | −0.88 to +0.38 | 0.250 | 0.49 | 0.63 | 3 | 24 | 24
completion | openai:gpt-4o less openai:gpt-4o, k=50 | 0.71 | 0.42 | −0.29 | −0.66 to +0.08 | −0.94 to +0.35 | 0.500 | 0.50 | 0.81 | 3 | 24 | 24
strict | openai:gpt-4o, k=50 less openai:gpt-4o, k=4 | 0.67 | 0.71 | +0.04 | −0.34 to +0.43 | −0.59 to +0.67 | 1.000 | 0.51 | 0.63 | 3 | 24 | 24
strict | openai:gpt-4o less openai:gpt-4o, k=4 | 0.67 | 0.42 | −0.25 | −0.62 to +0.12 | −0.88 to +0.38 | 0.250 | 0.49 | 0.63 | 3 | 24 | 24
strict | openai:gpt-4o less openai:gpt-4o, k=50 | 0.71 | 0.42 | −0.29 | −0.66 to +0.08 | −0.94 to +0.35 | 0.500 | 0.50 | 0.81 | 3 | 24 | 24
""",
    "comparison-more": """
measure | second less first | first’s mean | second’s mean | difference | would it repeat? | other tasks? | p | could have seen: same tasks | could have seen: other tasks | tasks | first’s n | second’s n
early stops | openai:gpt-4o, k=50 less openai:gpt-4o, k=4 | 0.33 | 0.29 | −0.04 | −0.43 to +0.34 | −0.67 to +0.59 | 1.000 | 0.51 | 0.63 | 3 | 24 | 24
early stops | openai:gpt-4o less openai:gpt-4o, k=4 | 0.33 | 0.58 | +0.25 | −0.12 to +0.62 | −0.38 to +0.88 | 0.250 | 0.49 | 0.63 | 3 | 24 | 24
early stops | openai:gpt-4o less openai:gpt-4o, k=50 | 0.29 | 0.58 | +0.29 | −0.08 to +0.66 | −0.35 to +0.94 | 0.500 | 0.50 | 0.81 | 3 | 24 | 24
false claims | openai:gpt-4o, k=50 less openai:gpt-4o, k=4 | 0.33 | 0.29 | −0.04 | −0.43 to +0.34 | −0.67 to +0.59 | 1.000 | 0.51 | 0.63 | 3 | 24 | 24
false claims | openai:gpt-4o less openai:gpt-4o, k=4 | 0.33 | 0.58 | +0.25 | −0.12 to +0.62 | −0.38 to +0.88 | 0.250 | 0.49 | 0.63 | 3 | 24 | 24
false claims | openai:gpt-4o less openai:gpt-4o, k=50 | 0.29 | 0.58 | +0.29 | −0.08 to +0.66 | −0.35 to +0.94 | 0.500 | 0.50 | 0.81 | 3 | 24 | 24
tool calls | openai:gpt-4o, k=50 less openai:gpt-4o, k=4 | 3.00 | 3.00 | 0.00 | 0.00 to 0.00 | 0.00 to 0.00 | 1.000 | 0.00 | 0.00 | 3 | 24 | 24
tool calls | openai:gpt-4o less openai:gpt-4o, k=4 | 3.00 | 3.00 | 0.00 | 0.00 to 0.00 | 0.00 to 0.00 | 1.000 | 0.00 | 0.00 | 3 | 24 | 24
tool calls | openai:gpt-4o less openai:gpt-4o, k=50 | 3.00 | 3.00 | 0.00 | 0.00 to 0.00 | 0.00 to 0.00 | 1.000 | 0.00 | 0.00 | 3 | 24 | 24
model calls | openai:gpt-4o, k=50 less openai:gpt-4o, k=4 | 4.00 | 4.00 | 0.00 | 0.00 to 0.00 | 0.00 to 0.00 | 1.000 | 0.00 | 0.00 | 3 | 24 | 24
model calls | openai:gpt-4o less openai:gpt-4o, k=4 | 4.00 | 4.00 | 0.00 | 0.00 to 0.00 | 0.00 to 0.00 | 1.000 | 0.00 | 0.00 | 3 | 24 | 24
model calls | openai:gpt-4o less openai:gpt-4o, k=50 | 4.00 | 4.00 | 0.00 | 0.00 to 0.00 | 0.00 to 0.00 | 1.000 | 0.00 | 0.00 | 3 | 24 | 24
tokens | openai:gpt-4o, k=50 less openai:gpt-4o, k=4 | 9,100 | 9,100 | 0 | 0 to 0 | 0 to 0 | 1.000 | 0 | 0 | 3 | 24 | 24
tokens | openai:gpt-4o less openai:gpt-4o, k=4 | 9,100 | 9,100 | 0 | 0 to 0 | 0 to 0 | 1.000 | 0 | 0 | 3 | 24 | 24
tokens | openai:gpt-4o less openai:gpt-4o, k=50 | 9,100 | 9,100 | 0 | 0 to 0 | 0 to 0 | 1.000 | 0 | 0 | 3 | 24 | 24
cost, $ | openai:gpt-4o, k=50 less openai:gpt-4o, k=4 | $0.0200 | $0.0200 | $0.00 | $0.00 to $0.00 | $0.00 to $0.00 | 1.000 | $0.00 | $0.00 | 3 | 24 | 24
cost, $ | openai:gpt-4o less openai:gpt-4o, k=4 | $0.0200 | $0.0200 | $0.00 | $0.00 to $0.00 | $0.00 to $0.00 | 1.000 | $0.00 | $0.00 | 3 | 24 | 24
cost, $ | openai:gpt-4o less openai:gpt-4o, k=50 | $0.0200 | $0.0200 | $0.00 | $0.00 to $0.00 | $0.00 to $0.00 | 1.000 | $0.00 | $0.00 | 3 | 24 | 24
seconds per call | openai:gpt-4o, k=50 less openai:gpt-4o, k=4 | 2.00 | 2.00 | 0.00 | 0.00 to 0.00 | 0.00 to 0.00 | 1.000 | 0.00 | 0.00 | 3 | 24 | 24
seconds per call | openai:gpt-4o less openai:gpt-4o, k=4 | 2.00 | 2.00 | 0.00 | 0.00 to 0.00 | 0.00 to 0.00 | 1.000 | 0.00 | 0.00 | 3 | 24 | 24
seconds per call | openai:gpt-4o less openai:gpt-4o, k=50 | 2.00 | 2.00 | 0.00 | 0.00 to 0.00 | 0.00 to 0.00 | 1.000 | 0.00 | 0.00 | 3 | 24 | 24
""",
    "tasks-opaq-s1": """
task | C-D printed | C-D computed | openai:gpt-4o, k=4 | would it repeat? | openai:gpt-4o, k=50 | would it repeat? | openai:gpt-4o | would it repeat? | GPT-4o (paper) | Claude 3.5 Sonnet (paper)
T1 | 1 | 1 | 0.50 | 0.00 to 1.00 | 1.00 | 0.22 to 1.00 | 0.50 | 0.00 to 1.00 | 1.00 | 1.00
T8 | 8 | 8 | 0.00 | 0.00 to 0.78 | 0.50 | 0.00 to 1.00 | 0.00 | 0.00 to 0.78 | 0.47 | 0.07
T14 | 15 | 18 | 0.50 | 0.00 to 1.00 | 1.00 | 0.22 to 1.00 | 0.00 | 0.00 to 0.78 | 0.37 | 0.44
""",
    "tasks-opaq-s2": """
task | C-D printed | C-D computed | openai:gpt-4o, k=4 | would it repeat? | openai:gpt-4o, k=50 | would it repeat? | openai:gpt-4o | would it repeat? | GPT-4o (paper) | Claude 3.5 Sonnet (paper)
T1 | 1 | 1 | 1.00 | 0.22 to 1.00 | 0.50 | 0.00 to 1.00 | 0.50 | 0.00 to 1.00 | 0.93 | 1.00
T8 | 8 | 8 | 0.00 | 0.00 to 0.78 | 0.50 | 0.00 to 1.00 | 0.00 | 0.00 to 0.78 | 0.77 | 0.47
T14 | 15 | 18 | 0.50 | 0.00 to 1.00 | 1.00 | 0.22 to 1.00 | 0.00 | 0.00 to 0.78 | 0.21 | 0.34
""",
    "tasks-sem-s1": """
task | C-D printed | C-D computed | openai:gpt-4o, k=4 | would it repeat? | openai:gpt-4o, k=50 | would it repeat? | openai:gpt-4o | would it repeat? | GPT-4o (paper) | Claude 3.5 Sonnet (paper)
T1 | 1 | 1 | 0.50 | 0.00 to 1.00 | 0.50 | 0.00 to 1.00 | 0.50 | 0.00 to 1.00 | 1.00 | 1.00
T8 | 8 | 8 | 1.00 | 0.22 to 1.00 | 0.50 | 0.00 to 1.00 | 0.50 | 0.00 to 1.00 | 1.00 | 1.00
T14 | 15 | 18 | 1.00 | 0.22 to 1.00 | 0.50 | 0.00 to 1.00 | 0.50 | 0.00 to 1.00 | 0.31 | 0.36
""",
    "tasks-sem-s2": """
task | C-D printed | C-D computed | openai:gpt-4o, k=4 | would it repeat? | openai:gpt-4o, k=50 | would it repeat? | openai:gpt-4o | would it repeat? | GPT-4o (paper) | Claude 3.5 Sonnet (paper)
T1 | 1 | 1 | 1.00 | 0.22 to 1.00 | 0.50 | 0.00 to 1.00 | 1.00 | 0.22 to 1.00 | 1.00 | 1.00
T8 | 8 | 8 | 1.00 | 0.22 to 1.00 | 1.00 | 0.22 to 1.00 | 0.50 | 0.00 to 1.00 | 1.00 | 1.00
T14 | 15 | 18 | 1.00 | 0.22 to 1.00 | 1.00 | 0.22 to 1.00 | 1.00 | 0.22 to 1.00 | 0.21 | 0.37
""",
    "averages": """
cells | model | completion | would it repeat? | other tasks? | s/call | Walk | Look | Look + first | Pick | Drop | Total | n
all labelings | openai:gpt-4o, k=4 | 0.67 | 0.44 to 0.90 | 0.04 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 24
all labelings | openai:gpt-4o, k=50 | 0.71 | 0.45 to 0.97 | 0.08 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 24
all labelings | openai:gpt-4o | 0.42 | 0.17 to 0.67 | 0.00 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 24
all labelings | GPT-4o (paper), published | 0.69 | 0.66 to 0.71 | 0.00 to 1.00 | 7.39 | 0.94 | 0.83 | 1.83 | 2.39 | 1.83 | 6.00 | 180
all labelings | Claude 3.5 Sonnet (paper), published | 0.67 | 0.64 to 0.70 | 0.00 to 1.00 | 7.91 | 0.19 | 0.89 | 1.89 | 2.01 | 1.69 | 4.77 | 179
all labelings | GPT-4o (paper), printed | 0.68 | – | – | 6.85 | – | – | – | – | – | 4.70 | –
all labelings | Claude 3.5 Sonnet (paper), printed | 0.61 | – | – | 8.01 | – | – | – | – | – | 4.19 | –
OPAQ | openai:gpt-4o, k=4 | 0.42 | 0.00 to 0.88 | 0.00 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 12
OPAQ | openai:gpt-4o, k=50 | 0.75 | 0.29 to 1.00 | 0.12 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 12
OPAQ | openai:gpt-4o | 0.17 | 0.00 to 0.67 | 0.00 to 0.88 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 12
OPAQ | GPT-4o (paper), published | 0.63 | 0.58 to 0.67 | 0.00 to 1.00 | 8.17 | 0.98 | 0.88 | 1.88 | 2.29 | 1.72 | 5.87 | 90
OPAQ | Claude 3.5 Sonnet (paper), published | 0.55 | 0.51 to 0.60 | 0.00 to 1.00 | 8.09 | 0.26 | 1.32 | 2.32 | 2.02 | 1.71 | 5.32 | 89
OPAQ | GPT-4o (paper), printed | 0.48 | – | – | 7.63 | 0.53 | – | 1.61 | – | – | 4.80 | –
OPAQ | Claude 3.5 Sonnet (paper), printed | 0.38 | – | – | 8.31 | 0.38 | – | 2.10 | – | – | 4.57 | –
SEM | openai:gpt-4o, k=4 | 0.92 | 0.00 to 1.00 | 0.29 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 12
SEM | openai:gpt-4o, k=50 | 0.67 | 0.20 to 1.00 | 0.04 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 12
SEM | openai:gpt-4o | 0.67 | 0.20 to 1.00 | 0.04 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 12
SEM | GPT-4o (paper), published | 0.75 | 0.72 to 0.79 | 0.00 to 1.00 | 6.60 | 0.91 | 0.78 | 1.78 | 2.50 | 1.94 | 6.13 | 90
SEM | Claude 3.5 Sonnet (paper), published | 0.79 | 0.76 to 0.82 | 0.00 to 1.00 | 7.74 | 0.11 | 0.47 | 1.47 | 1.99 | 1.67 | 4.23 | 90
SEM | GPT-4o (paper), printed | 0.88 | – | – | 6.06 | 0.62 | – | 1.41 | – | – | 4.60 | –
SEM | Claude 3.5 Sonnet (paper), printed | 0.83 | – | – | 7.72 | 0.23 | – | 1.25 | – | – | 3.80 | –
OPAQ, S1 | openai:gpt-4o, k=4 | 0.33 | 0.00 to 1.00 | 0.00 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 6
OPAQ, S1 | openai:gpt-4o, k=50 | 0.83 | 0.00 to 1.00 | 0.12 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 6
OPAQ, S1 | openai:gpt-4o | 0.17 | 0.00 to 1.00 | 0.00 to 0.88 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 6
OPAQ, S1 | GPT-4o (paper), published | 0.61 | 0.55 to 0.68 | 0.00 to 1.00 | 5.76 | 0.02 | 0.31 | 1.31 | 2.27 | 1.84 | 4.44 | 45
OPAQ, S1 | Claude 3.5 Sonnet (paper), published | 0.50 | 0.44 to 0.57 | 0.00 to 1.00 | 8.27 | 0.31 | 1.40 | 2.40 | 2.11 | 1.82 | 5.64 | 45
OPAQ, S2 | openai:gpt-4o, k=4 | 0.50 | 0.00 to 1.00 | 0.00 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 6
OPAQ, S2 | openai:gpt-4o, k=50 | 0.67 | 0.00 to 1.00 | 0.00 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 6
OPAQ, S2 | openai:gpt-4o | 0.17 | 0.00 to 1.00 | 0.00 to 0.88 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 6
OPAQ, S2 | GPT-4o (paper), published | 0.64 | 0.56 to 0.72 | 0.00 to 1.00 | 10.59 | 1.93 | 1.44 | 2.44 | 2.31 | 1.60 | 7.29 | 45
OPAQ, S2 | Claude 3.5 Sonnet (paper), published | 0.60 | 0.52 to 0.68 | 0.00 to 1.00 | 7.90 | 0.21 | 1.25 | 2.25 | 1.93 | 1.60 | 4.99 | 44
SEM, S1 | openai:gpt-4o, k=4 | 0.83 | 0.00 to 1.00 | 0.12 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 6
SEM, S1 | openai:gpt-4o, k=50 | 0.50 | 0.00 to 1.00 | 0.00 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 6
SEM, S1 | openai:gpt-4o | 0.50 | 0.00 to 1.00 | 0.00 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 6
SEM, S1 | GPT-4o (paper), published | 0.77 | 0.70 to 0.83 | 0.00 to 1.00 | 5.02 | 0.00 | 0.22 | 1.22 | 2.49 | 2.11 | 4.82 | 45
SEM, S1 | Claude 3.5 Sonnet (paper), published | 0.79 | 0.72 to 0.85 | 0.00 to 1.00 | 7.83 | 0.09 | 0.36 | 1.36 | 2.04 | 1.71 | 4.20 | 45
SEM, S1 | GPT-4o (paper), printed | 0.93 | – | – | 4.71 | 0.00 | – | 1.08 | – | – | 3.67 | –
SEM, S1 | Claude 3.5 Sonnet (paper), printed | 0.90 | – | – | 7.94 | 0.19 | – | 1.19 | – | – | 3.75 | –
SEM, S2 | openai:gpt-4o, k=4 | 1.00 | 0.61 to 1.00 | 0.37 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 6
SEM, S2 | openai:gpt-4o, k=50 | 0.83 | 0.00 to 1.00 | 0.12 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 6
SEM, S2 | openai:gpt-4o | 0.83 | 0.00 to 1.00 | 0.12 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 6
SEM, S2 | GPT-4o (paper), published | 0.74 | 0.67 to 0.80 | 0.00 to 1.00 | 8.18 | 1.82 | 1.33 | 2.33 | 2.51 | 1.78 | 7.44 | 45
SEM, S2 | Claude 3.5 Sonnet (paper), published | 0.79 | 0.73 to 0.86 | 0.00 to 1.00 | 7.65 | 0.13 | 0.58 | 1.58 | 1.93 | 1.62 | 4.27 | 45
SEM, S2 | GPT-4o (paper), printed | 0.83 | – | – | 7.12 | 1.24 | – | 1.74 | – | – | 5.53 | –
SEM, S2 | Claude 3.5 Sonnet (paper), printed | 0.76 | – | – | 7.49 | 0.28 | – | 1.30 | – | – | 5.89 | –
""",
    "families": """
family | model | completion | would it repeat? | other tasks? | strict | model calls | tokens | n
single object | openai:gpt-4o, k=4 | 0.75 | 0.00 to 1.00 | – | 0.75 | 4.00 | 9,100 | 8
single object | openai:gpt-4o, k=50 | 0.62 | 0.00 to 1.00 | – | 0.62 | 4.00 | 9,100 | 8
single object | openai:gpt-4o | 0.62 | 0.00 to 1.00 | – | 0.62 | 4.00 | 9,100 | 8
single object | GPT-4o (paper) | 0.98 | 0.93 to 1.00 | – | – | 4.77 | 34,282 | 60
single object | Claude 3.5 Sonnet (paper) | 1.00 | 0.95 to 1.00 | – | – | 2.02 | 13,272 | 60
several objects | openai:gpt-4o, k=4 | 0.50 | 0.19 to 0.81 | – | 0.50 | 4.00 | 9,100 | 8
several objects | openai:gpt-4o, k=50 | 0.62 | 0.00 to 1.00 | – | 0.62 | 4.00 | 9,100 | 8
several objects | openai:gpt-4o | 0.25 | 0.00 to 1.00 | – | 0.25 | 4.00 | 9,100 | 8
several objects | GPT-4o (paper) | 0.81 | 0.76 to 0.86 | – | – | 5.63 | 39,736 | 60
several objects | Claude 3.5 Sonnet (paper) | 0.63 | 0.57 to 0.69 | – | – | 5.50 | 40,866 | 60
attribute-heavy and long | openai:gpt-4o, k=4 | 0.75 | 0.00 to 1.00 | – | 0.75 | 4.00 | 9,100 | 8
attribute-heavy and long | openai:gpt-4o, k=50 | 0.88 | 0.00 to 1.00 | – | 0.88 | 4.00 | 9,100 | 8
attribute-heavy and long | openai:gpt-4o | 0.38 | 0.00 to 1.00 | – | 0.38 | 4.00 | 9,100 | 8
attribute-heavy and long | GPT-4o (paper) | 0.28 | 0.23 to 0.33 | – | – | 10.32 | 103,507 | 60
attribute-heavy and long | Claude 3.5 Sonnet (paper) | 0.38 | 0.32 to 0.44 | – | – | 9.77 | 93,032 | 59
""",
    "labelings": """
model | OPAQ | SEM | difference | would it repeat? | other tasks? | p | gain | Looks
openai:gpt-4o, k=4 | 0.42 | 0.92 | +0.50 | −1.00 to +1.00 | −0.74 to +1.00 | 0.500 | +120.0 % | 0.0 %
openai:gpt-4o, k=50 | 0.75 | 0.67 | −0.08 | −0.78 to +0.62 | −0.80 to +0.63 | 1.000 | −11.1 % | 0.0 %
openai:gpt-4o | 0.17 | 0.67 | +0.50 | −0.38 to +1.00 | −0.13 to +1.00 | 0.250 | +300.0 % | 0.0 %
GPT-4o (paper), printed | 0.48 | 0.88 | +0.40 | – | – | – | +83.3 % | −12.4 %
Claude 3.5 Sonnet (paper), printed | 0.38 | 0.83 | +0.45 | – | – | – | +118.4 % | −40.5 %
""",
    "spearman": """
model | labeling | ρ: printed, tasks | p: printed, tasks | ρ: printed, cells | p: printed, cells | ρ: computed, tasks | p: computed, tasks | ρ: computed, cells | p: computed, cells | tasks | cells
openai:gpt-4o, k=4 | all | 0.00 | 1.000 | 0.00 | 1.000 | 0.00 | 1.000 | 0.00 | 1.000 | 3 | 12
openai:gpt-4o, k=4 | OPAQ | −0.50 | 0.667 | −0.26 | 0.621 | −0.50 | 0.667 | −0.26 | 0.621 | 3 | 6
openai:gpt-4o, k=4 | SEM | 0.87 | 0.333 | 0.55 | 0.261 | 0.87 | 0.333 | 0.55 | 0.261 | 3 | 6
openai:gpt-4o, k=50 | all | 0.87 | 0.333 | 0.41 | 0.181 | 0.87 | 0.333 | 0.41 | 0.181 | 3 | 12
openai:gpt-4o, k=50 | OPAQ | 0.50 | 0.667 | 0.41 | 0.422 | 0.50 | 0.667 | 0.41 | 0.422 | 3 | 6
openai:gpt-4o, k=50 | SEM | 0.87 | 0.333 | 0.43 | 0.391 | 0.87 | 0.333 | 0.43 | 0.391 | 3 | 6
openai:gpt-4o | all | −0.50 | 0.667 | −0.32 | 0.306 | −0.50 | 0.667 | −0.32 | 0.306 | 3 | 12
openai:gpt-4o | OPAQ | −0.87 | 0.333 | −0.87 | 0.026 | −0.87 | 0.333 | −0.87 | 0.026 | 3 | 6
openai:gpt-4o | SEM | 0.00 | 1.000 | 0.00 | 1.000 | 0.00 | 1.000 | 0.00 | 1.000 | 3 | 6
GPT-4o and Claude 3.5 Sonnet (paper), published | all | −1.00 | < 0.001 | −0.79 | < 0.001 | −1.00 | < 0.001 | −0.79 | < 0.001 | 3 | 24
GPT-4o and Claude 3.5 Sonnet (paper), published | OPAQ | −1.00 | < 0.001 | −0.84 | < 0.001 | −1.00 | < 0.001 | −0.84 | < 0.001 | 3 | 12
GPT-4o and Claude 3.5 Sonnet (paper), published | SEM | −0.87 | 0.333 | −0.84 | < 0.001 | −0.87 | 0.333 | −0.84 | < 0.001 | 3 | 12
the paper, printed | SEM | −0.53 | < 0.05 | – | – | – | – | – | – | – | –
""",
    "failure-classes": """
labeling | model | scored | failed | perceptual | execution | reasoning | protocol (count) | undiagnosed (count)
OPAQ | all vlm models | 36 | 20 | 33.3 % | 27.8 % | 38.9 % | 2 | 0
OPAQ | openai:gpt-4o, k=4 | 12 | 7 | 66.7 % | 16.7 % | 16.7 % | 1 | 0
OPAQ | openai:gpt-4o, k=50 | 12 | 3 | 0.0 % | 66.7 % | 33.3 % | 0 | 0
OPAQ | openai:gpt-4o | 12 | 10 | 22.2 % | 22.2 % | 55.6 % | 1 | 0
OPAQ | both models (paper), printed | – | – | 83.5 % | 14.2 % | – | – | –
SEM | all vlm models | 36 | 9 | 28.6 % | 28.6 % | 42.9 % | 2 | 0
SEM | openai:gpt-4o, k=4 | 12 | 1 | 100.0 % | 0.0 % | 0.0 % | 0 | 0
SEM | openai:gpt-4o, k=50 | 12 | 4 | 50.0 % | 50.0 % | 0.0 % | 2 | 0
SEM | openai:gpt-4o | 12 | 4 | 0.0 % | 25.0 % | 75.0 % | 0 | 0
SEM | both models (paper), printed | – | – | 65.8 % | 31.1 % | – | – | –
""",
    "failure-codes-vlm": """
class | code | what it means | OPAQ | SEM | all | share
perceptual | wrong object | Another object was taken in place of the one that was asked for. | 6 | 2 | 8 | 27.6 %
execution | false claim | The agent ended too early and said that all was done. | 5 | 2 | 7 | 24.1 %
reasoning | goal forgotten | A part of the instruction was never named nor tried. | 7 | 3 | 10 | 34.5 %
protocol | unreadable | Replies could not be read as a call or an answer. | 2 | 2 | 4 | 13.8 %
""",
    "ablation-k": """
model | k | completion | would it repeat? | other tasks? | Look + first | model calls | s/call | tokens | cut prompts | n
openai:gpt-4o | 4 | 0.67 | 0.44 to 0.90 | 0.04 to 1.00 | 2.00 | 4.00 | 2.00 | 9,100 | 0.00 | 24
openai:gpt-4o | 50 | 0.71 | 0.45 to 0.97 | 0.08 to 1.00 | 2.00 | 4.00 | 2.00 | 9,100 | 0.00 | 24
GPT-4o (paper) | 4 | 0.82 | – | – | 1.27 | 6.34 | 3.94 | – | – | –
GPT-4o (paper) | 6 | 0.84 | – | – | 1.20 | 9.20 | 3.85 | – | – | –
GPT-4o (paper) | 10 | 0.86 | – | – | 1.47 | 6.99 | 4.05 | – | – | –
GPT-4o (paper) | 50 | 0.93 | – | – | 1.08 | 4.67 | 4.71 | – | – | –
""",
    "calls": """
labeling | model | Walk | Look | Pick | Drop | all tools | model calls | requests
all labelings | openai:gpt-4o, k=4 | 0.00 | 1.00 | 1.00 | 1.00 | 3.00 | 4.00 | 4.00
all labelings | openai:gpt-4o, k=50 | 0.00 | 1.00 | 1.00 | 1.00 | 3.00 | 4.00 | 4.00
all labelings | openai:gpt-4o | 0.00 | 1.00 | 1.00 | 1.00 | 3.00 | 4.00 | 4.00
all labelings | GPT-4o (paper) | 0.94 | 0.83 | 2.39 | 1.83 | 6.00 | 6.91 | –
all labelings | Claude 3.5 Sonnet (paper) | 0.19 | 0.89 | 2.01 | 1.69 | 4.77 | 5.76 | –
OPAQ | openai:gpt-4o, k=4 | 0.00 | 1.00 | 1.00 | 1.00 | 3.00 | 4.00 | 4.00
OPAQ | openai:gpt-4o, k=50 | 0.00 | 1.00 | 1.00 | 1.00 | 3.00 | 4.00 | 4.00
OPAQ | openai:gpt-4o | 0.00 | 1.00 | 1.00 | 1.00 | 3.00 | 4.00 | 4.00
OPAQ | GPT-4o (paper) | 0.98 | 0.88 | 2.29 | 1.72 | 5.87 | 6.74 | –
OPAQ | Claude 3.5 Sonnet (paper) | 0.26 | 1.32 | 2.02 | 1.71 | 5.32 | 6.32 | –
SEM | openai:gpt-4o, k=4 | 0.00 | 1.00 | 1.00 | 1.00 | 3.00 | 4.00 | 4.00
SEM | openai:gpt-4o, k=50 | 0.00 | 1.00 | 1.00 | 1.00 | 3.00 | 4.00 | 4.00
SEM | openai:gpt-4o | 0.00 | 1.00 | 1.00 | 1.00 | 3.00 | 4.00 | 4.00
SEM | GPT-4o (paper) | 0.91 | 0.78 | 2.50 | 1.94 | 6.13 | 7.07 | –
SEM | Claude 3.5 Sonnet (paper) | 0.11 | 0.47 | 1.99 | 1.67 | 4.23 | 5.21 | –
""",
    "tokens": """
labeling | model | tokens | in | cached | out | reasoning | tokens per solved | cost | cost per solved | solved
all labelings | openai:gpt-4o, k=4 | 9,100 | 9,000 | 0 | 100 | 0 | 13,650 | $0.0200 | $0.0300 | 16
all labelings | openai:gpt-4o, k=50 | 9,100 | 9,000 | 0 | 100 | 0 | 12,847 | $0.0200 | $0.0282 | 17
all labelings | openai:gpt-4o | 9,100 | 9,000 | 0 | 100 | 0 | 21,840 | $0.0200 | $0.0480 | 10
all labelings | GPT-4o (paper) | 59,175 | 58,799 | – | 375 | – | – | – | – | –
all labelings | Claude 3.5 Sonnet (paper) | 49,057 | 48,388 | – | 668 | – | – | – | – | –
OPAQ | openai:gpt-4o, k=4 | 9,100 | 9,000 | 0 | 100 | 0 | 21,840 | $0.0200 | $0.0480 | 5
OPAQ | openai:gpt-4o, k=50 | 9,100 | 9,000 | 0 | 100 | 0 | 12,133 | $0.0200 | $0.0267 | 9
OPAQ | openai:gpt-4o | 9,100 | 9,000 | 0 | 100 | 0 | 54,600 | $0.0200 | $0.1200 | 2
OPAQ | GPT-4o (paper) | 58,374 | 57,978 | – | 396 | – | – | – | – | –
OPAQ | Claude 3.5 Sonnet (paper) | 56,919 | 56,184 | – | 735 | – | – | – | – | –
SEM | openai:gpt-4o, k=4 | 9,100 | 9,000 | 0 | 100 | 0 | 9,927 | $0.0200 | $0.0218 | 11
SEM | openai:gpt-4o, k=50 | 9,100 | 9,000 | 0 | 100 | 0 | 13,650 | $0.0200 | $0.0300 | 8
SEM | openai:gpt-4o | 9,100 | 9,000 | 0 | 100 | 0 | 13,650 | $0.0200 | $0.0300 | 8
SEM | GPT-4o (paper) | 59,975 | 59,620 | – | 355 | – | – | – | – | –
SEM | Claude 3.5 Sonnet (paper) | 41,194 | 40,593 | – | 601 | – | – | – | – | –
""",
    "time": """
labeling | model | model s/call | model s | world s | waited s
all labelings | openai:gpt-4o, k=4 | 2.00 | 8.00 | 1.00 | 0.00
all labelings | openai:gpt-4o, k=50 | 2.00 | 8.00 | 1.00 | 0.00
all labelings | openai:gpt-4o | 2.00 | 8.00 | 1.00 | 0.00
all labelings | GPT-4o (paper) | 7.39 | 59.95 | – | –
all labelings | Claude 3.5 Sonnet (paper) | 7.91 | 48.32 | – | –
OPAQ | openai:gpt-4o, k=4 | 2.00 | 8.00 | 1.00 | 0.00
OPAQ | openai:gpt-4o, k=50 | 2.00 | 8.00 | 1.00 | 0.00
OPAQ | openai:gpt-4o | 2.00 | 8.00 | 1.00 | 0.00
OPAQ | GPT-4o (paper) | 8.17 | 65.51 | – | –
OPAQ | Claude 3.5 Sonnet (paper) | 8.09 | 55.29 | – | –
SEM | openai:gpt-4o, k=4 | 2.00 | 8.00 | 1.00 | 0.00
SEM | openai:gpt-4o, k=50 | 2.00 | 8.00 | 1.00 | 0.00
SEM | openai:gpt-4o | 2.00 | 8.00 | 1.00 | 0.00
SEM | GPT-4o (paper) | 6.60 | 54.38 | – | –
SEM | Claude 3.5 Sonnet (paper) | 7.74 | 41.36 | – | –
""",
    "conduct": """
labeling | model | completion | strict | early stops | false claims | refused calls | corrected calls | protocol failures | missing notes | cut prompts | walked, m | path / oracle’s
all labelings | openai:gpt-4o, k=4 | 0.67 | 0.67 | 33.3 % | 33.3 % | 0.00 | 0.00 | 0.00 | 0.00 | 0.00 | 2.00 | 2.00
all labelings | openai:gpt-4o, k=50 | 0.71 | 0.71 | 29.2 % | 29.2 % | 0.00 | 0.00 | 0.00 | 0.00 | 0.00 | 2.00 | 2.00
all labelings | openai:gpt-4o | 0.42 | 0.42 | 58.3 % | 58.3 % | 0.00 | 0.00 | 0.00 | 0.00 | 0.00 | 2.00 | 2.00
all labelings | GPT-4o (paper) | 0.69 | – | – | – | – | – | – | – | – | – | –
all labelings | Claude 3.5 Sonnet (paper) | 0.67 | – | – | – | – | – | – | – | – | – | –
OPAQ | openai:gpt-4o, k=4 | 0.42 | 0.42 | 58.3 % | 58.3 % | 0.00 | 0.00 | 0.00 | 0.00 | 0.00 | 2.00 | 2.00
OPAQ | openai:gpt-4o, k=50 | 0.75 | 0.75 | 25.0 % | 25.0 % | 0.00 | 0.00 | 0.00 | 0.00 | 0.00 | 2.00 | 2.00
OPAQ | openai:gpt-4o | 0.17 | 0.17 | 83.3 % | 83.3 % | 0.00 | 0.00 | 0.00 | 0.00 | 0.00 | 2.00 | 2.00
OPAQ | GPT-4o (paper) | 0.63 | – | – | – | – | – | – | – | – | – | –
OPAQ | Claude 3.5 Sonnet (paper) | 0.55 | – | – | – | – | – | – | – | – | – | –
SEM | openai:gpt-4o, k=4 | 0.92 | 0.92 | 8.3 % | 8.3 % | 0.00 | 0.00 | 0.00 | 0.00 | 0.00 | 2.00 | 2.00
SEM | openai:gpt-4o, k=50 | 0.67 | 0.67 | 33.3 % | 33.3 % | 0.00 | 0.00 | 0.00 | 0.00 | 0.00 | 2.00 | 2.00
SEM | openai:gpt-4o | 0.67 | 0.67 | 33.3 % | 33.3 % | 0.00 | 0.00 | 0.00 | 0.00 | 0.00 | 2.00 | 2.00
SEM | GPT-4o (paper) | 0.75 | – | – | – | – | – | – | – | – | – | –
SEM | Claude 3.5 Sonnet (paper) | 0.79 | – | – | – | – | – | – | – | – | – | –
""",
}
"""The same model in two studies, the second with two values of k."""
