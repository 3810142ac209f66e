"""The texts of a report of one small study, whole: for people, and for a paper."""

# ruff: noqa: E501 - a paragraph stands on a line.

from __future__ import annotations

MARKDOWN = r"""# Tiny

2 tasks in S1 under SEM with openai:gpt-4o: 4 scored episodes.

## How good, and how sure

Each task counts once, whatever number of episodes it has. Episodes that a fault of ours or of a provider ended are unscored: they are in no figure.

### Completion and strict score

Completion is the mean fraction of a task’s conditions that hold at the end, as in the paper. Strict counts an episode only if all conditions hold and nothing else was moved, overlaps or floats. Two 95 % intervals answer two questions. “Would it repeat?”: where the mean lies if the same episodes were played again. “Other tasks?”: where it would lie on other tasks like these. pass^k is how likely k episodes of a cell are all strict successes, for the largest k that every cell was played. n counts scored episodes. Rows of the paper are means of its published data over the same scenes, labelings and tasks.

| model | kind | completion | would it repeat? | other tasks? | strict | strict: would it repeat? | strict: other tasks? | pass^k | k | tasks | n | unscored |
| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |
| openai:gpt-4o | vlm | 0.88 | 0.00 to 1.00 | 0.00 to 1.00 | 0.75 | 0.00 to 1.00 | 0.00 to 1.00 | 0.50 | 2 | 2 | 4 | 0 |
| GPT-4o (paper) | vlm | 1.00 | 0.90 to 1.00 | 0.22 to 1.00 | – (a) | – (a) | – (a) | – (a) | – (a) | 2 | 30 | – (a) |
| Claude 3.5 Sonnet (paper) | vlm | 1.00 | 0.90 to 1.00 | 0.22 to 1.00 | – (a) | – (a) | – (a) | – (a) | – (a) | 2 | 30 | – (a) |

(a) the paper does not tell.

## Task by task

Which tasks are done, and in which scene and under which labeling they are not.

### Completion by task: SEM, S1

Mean completion of each task’s episodes, with the 95 % interval of its repetitions. The C-D level says how hard a task is: as the paper prints it, and as its own rules give it.

| task | C-D printed | C-D computed | openai:gpt-4o | would it repeat? | GPT-4o (paper) | Claude 3.5 Sonnet (paper) |
| --- | ---: | ---: | ---: | ---: | ---: | ---: |
| T1 | 1 | 1 | 1.00 | 0.22 to 1.00 | 1.00 | 1.00 |
| T8 | 8 | 8 | 0.75 | 0.00 to 1.00 | 1.00 | 1.00 |

## Averages, as in the paper

The paper’s table of averages for the models played here, with the paper’s own rows: as it prints them, and as the data that its authors published gives them.

### Averages by labeling and scene

Means over tasks and episodes. Tool calls are per episode; the first view, which nobody asks for, is left out of Look and Total, and counted in “Look + first”, as the paper prints it. Rows “published” are means of the cells that its authors published, over the scenes and tasks of this study; rows “printed” stand in the paper, over all of its tasks.

| cells | model | completion | would it repeat? | other tasks? | s/call | Walk | Look | Look + first | Pick | Drop | Total | n |
| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |
| SEM | openai:gpt-4o | 0.88 | 0.00 to 1.00 | 0.00 to 1.00 | 2.00 | 0.00 | 1.00 | 2.00 | 1.00 | 1.00 | 3.00 | 4 |
| SEM | GPT-4o (paper), published | 1.00 | 0.90 to 1.00 | 0.22 to 1.00 | 4.53 | 0.00 | 0.00 | 1.00 | 1.57 | 1.00 | 2.57 | 30 |
| SEM | Claude 3.5 Sonnet (paper), published | 1.00 | 0.90 to 1.00 | 0.22 to 1.00 | 7.50 | 0.00 | 0.00 | 1.00 | 1.50 | 1.00 | 2.50 | 30 |
| SEM | GPT-4o (paper), printed | 0.88 | – (a) | – (a) | 6.06 | 0.62 | – (a) | 1.41 | – (a) | – (a) | 4.60 | – (a) |
| SEM | Claude 3.5 Sonnet (paper), printed | 0.83 | – (a) | – (a) | 7.72 | 0.23 | – (a) | 1.25 | – (a) | – (a) | 3.80 | – (a) |

(a) the paper does not print it.

### Averages by task family

The paper’s families of tasks, from picking a single object to long tasks that need attributes. Over all scenes and labelings of this study; model calls and tokens are per episode.

| family | model | completion | would it repeat? | other tasks? | strict | model calls | tokens | n |
| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |
| single object | openai:gpt-4o | 1.00 | 0.22 to 1.00 | – (a) | 1.00 | 4.00 | 9,100 | 2 |
| single object | GPT-4o (paper) | 1.00 | 0.82 to 1.00 | – (a) | – (b) | 2.00 | 13,193 | 15 |
| single object | Claude 3.5 Sonnet (paper) | 1.00 | 0.82 to 1.00 | – (a) | – (b) | 2.00 | 13,188 | 15 |
| several objects | openai:gpt-4o | 0.75 | 0.00 to 1.00 | – (a) | 0.50 | 4.00 | 9,100 | 2 |
| several objects | GPT-4o (paper) | 1.00 | 0.82 to 1.00 | – (a) | – (b) | 5.13 | 34,332 | 15 |
| several objects | Claude 3.5 Sonnet (paper) | 1.00 | 0.82 to 1.00 | – (a) | – (b) | 5.00 | 34,415 | 15 |

(a) a single task; (b) the paper has no strict score.

## What labels are worth

Only one of the paper’s two labelings was played, so there is nothing to compare.

## Difficulty and completion

The C-D level of a task adds up what its prompt asks for. The paper finds that completion falls as it rises.

### Rank correlation of C-D level and completion

Spearman’s ρ from -1 (the harder, the worse) to 1, and how often chance alone gives one as strong. Each over the tasks’ means and over all cells, with the printed and with the computed level. The paper’s own figure stands in the first columns; its published data gives a weaker one.

| model | labeling | ρ: printed, tasks | p: printed, tasks | ρ: printed, cells | p: printed, cells | ρ: computed, tasks | p: computed, tasks | ρ: computed, cells | p: computed, cells | tasks | cells |
| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |
| openai:gpt-4o | SEM | – (a) | – (a) | – (a) | – (a) | – (a) | – (a) | – (a) | – (a) | 2 | 2 |
| GPT-4o and Claude 3.5 Sonnet (paper), published | SEM | – (a) | – (a) | – (a) | – (a) | – (a) | – (a) | – (a) | – (a) | 2 | 4 |
| the paper, printed | SEM | −0.53 | \< 0.05 | – (b) | – (b) | – (b) | – (b) | – (b) | – (b) | – (b) | – (b) |

(a) fewer than 3 points, or one of the two does not vary; (b) the paper prints one correlation and does not say over what.

## Why episodes failed

Every scored episode below 1.0 has a diagnosis, made from the simulator’s truth: the paper’s class, and a finer code. The paper’s percentages are over its three classes; failures to give a valid call (protocol) stand apart.

### Failures by class

Perceptual: the wrong object or place, or one never found. Execution: the right intent, but refused, misplaced or ended too early. Reasoning: wrong order, something not asked, a goal forgotten, a loop. Percentages are of these three together, as in the paper. Protocol counts episodes without a valid call, undiagnosed those that nobody has explained.

| labeling | model | scored | failed | perceptual | execution | reasoning | protocol (count) | undiagnosed (count) |
| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |
| SEM | openai:gpt-4o | 4 | 1 | 0.0 % | 0.0 % | 100.0 % | 0 | 0 |
| SEM | both models (paper), printed | – (a) | – (a) | 65.8 % | 31.1 % | – (a) | – (a) | – (a) |

(a) the paper says 2 to 3 % of reasoning, and no counts.

### Failures by code: vlm models

What exactly went wrong first, over all models of a kind, with the number of failed episodes under each labeling and the share of all failures.

| class | code | what it means | SEM | all | share |
| --- | --- | --- | ---: | ---: | ---: |
| reasoning | – |  | 1 | 1 | 100.0 % |

## What it takes

Means per episode, each task counted once. Unscored episodes are left out.

### Calls

Tool calls by kind, calls of the model, and requests to its provider, which count repairs and failed tries too. Look leaves out the first view, which nobody asks for.

| labeling | model | Walk | Look | Pick | Drop | all tools | model calls | requests |
| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: |
| all labelings | openai:gpt-4o | 0.00 | 1.00 | 1.00 | 1.00 | 3.00 | 4.00 | 4.00 |
| all labelings | GPT-4o (paper) | 0.00 | 0.00 | 1.57 | 1.00 | 2.57 | 3.57 | – (a) |
| all labelings | Claude 3.5 Sonnet (paper) | 0.00 | 0.00 | 1.50 | 1.00 | 2.50 | 3.50 | – (a) |

(a) the paper does not tell.

### Tokens and money

Tokens of all model calls of an episode; cached ones are part of those that went in. Cost is what was spent at list prices; cost and tokens per solved task count the failed episodes too.

| labeling | model | tokens | in | cached | out | reasoning | tokens per solved | cost | cost per solved | solved |
| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |
| all labelings | openai:gpt-4o | 9,100 | 9,000 | 0 | 100 | 0 | 12,133 | \$0.0200 | \$0.0267 | 3 |
| all labelings | GPT-4o (paper) | 23,762 | 23,676 | – (a) | 87 | – (a) | – (a) | – (a) | – (a) | – (a) |
| all labelings | Claude 3.5 Sonnet (paper) | 23,802 | 23,421 | – (a) | 381 | – (a) | – (a) | – (a) | – (a) | – (a) |

(a) the paper does not tell.

### Time

Seconds an episode: of the model, of the world that carries the calls out, and of waits for rate limits and retries, which count against no limit.

| labeling | model | model s/call | model s | world s | waited s |
| --- | --- | ---: | ---: | ---: | ---: |
| all labelings | openai:gpt-4o | 2.00 | 8.00 | 1.00 | 0.00 |
| all labelings | GPT-4o (paper) | 4.53 | 15.21 | – (a) | – (a) |
| all labelings | Claude 3.5 Sonnet (paper) | 7.50 | 25.60 | – (a) | – (a) |

(a) the paper does not tell.

## How they behave

### Stops, claims, refusals and ways

Early stops: share of episodes that the agent ended with conditions open. False claims: those in which it said that all was done. Refused calls changed nothing, corrected ones were carried out otherwise than asked; protocol failures are replies that were neither a call nor an answer; cut prompts no longer held every reply before; each per episode. Path / oracle’s is metres walked over those of the oracle, in complete episodes for which these are known: those in a scene as it is.

| labeling | model | completion | strict | early stops | false claims | refused calls | corrected calls | protocol failures | missing notes | cut prompts | walked, m | path / oracle’s |
| --- | --- | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: | ---: |
| all labelings | openai:gpt-4o | 0.88 | 0.75 | 25.0 % | 25.0 % | 0.00 | 0.00 | 0.00 | 0.00 | 0.00 | 2.00 | 2.00 |
| all labelings | GPT-4o (paper) | 1.00 | – (a) | – (a) | – (a) | – (a) | – (a) | – (a) | – (a) | – (a) | – (a) | – (a) |
| all labelings | Claude 3.5 Sonnet (paper) | 1.00 | – (a) | – (a) | – (a) | – (a) | – (a) | – (a) | – (a) | – (a) | – (a) | – (a) |

(a) the paper does not tell.

## What was asked

### The tasks and their C-D levels

What the agent is told, and the Capability-Difficulty level: the sum of what the prompt asks for in actions (ACT), references (REF) and relations (REL). Three of the paper’s sums do not add up, and two references break its own rules, so the level that its rules give stands beside the printed one.

| task | prompt | family | conditions | ACT | REF | REL | C-D printed | C-D computed |
| --- | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |
| T1 | Pick the object tagged as 34 | single object | 1 | 1 | 0 | 0 | 1 | 1 |
| T8 | Pick the glass and the plate then put them on the floor | several objects | 2 | 4 | 2 | 2 | 8 | 8 |

### The C-D taxonomy

What each unit of a prompt adds to its level. Walking and looking are not counted.

| dimension | unit | what it asks for | level |
| --- | --- | --- | ---: |
| ACT | pick | pick an object | 1 |
| ACT | drop | release or place an object | 1 |
| REF | id | a number, unique in the scene | 0 |
| REF | tag | a semantic tag or name | 1 |
| REF | attrColor | a colour | 1 |
| REF | attrShape | a shape | 2 |
| REF | groupSimple | a group, filtered by one criterion | 2 |
| REF | attrPattern | a pattern | 3 |
| REF | superExtremum | a superlative: least or most of an attribute | 3 |
| REL | floor | on the floor | 1 |
| REL | prox | near another object | 2 |
| REL | area | within a designated area | 4 |

## Every cell and its episodes

A cell is all episodes that are alike but for repetition and variation. Each small square is one episode, coloured by its completion from red (0) to green (1), grey if unscored; it leads to its page where one was made, else to its record.

### openai:gpt-4o, SEM, S1

Completion and strict score of each task, with the interval of its repetitions.

| task | completion | would it repeat? | strict | model calls | tokens | variations | n | unscored |
| --- | ---: | ---: | ---: | ---: | ---: | --- | ---: | ---: |
| T1 | 1.00 | 0.22 to 1.00 | 1.00 | 4.00 | 9,100 | 0 | 2 | 0 |
| T8 | 0.75 | 0.00 to 1.00 | 0.50 | 4.00 | 9,100 | 0 | 2 | 0 |
"""

LATEX = r"""% Tiny

% Needs \usepackage{booktabs}; wide tables may want \resizebox or table*.

\begin{table}
  \centering\footnotesize
  \caption{Completion and strict score. Completion is the mean fraction of a task's conditions that hold at the end, as in the paper. Strict counts an episode only if all conditions hold and nothing else was moved, overlaps or floats. Two 95 \% intervals answer two questions. ``Would it repeat?'': where the mean lies if the same episodes were played again. ``Other tasks?'': where it would lie on other tasks like these. pass\textasciicircum{}k is how likely k episodes of a cell are all strict successes, for the largest k that every cell was played. n counts scored episodes. Rows of the paper are means of its published data over the same scenes, labelings and tasks. (a) the paper does not tell.}
  \label{tab:headline}
  \begin{tabular}{llrrrrrrrrrrr}
    \toprule
    model & kind & completion & \shortstack[r]{would it\\repeat?} & other tasks? & strict & \shortstack[r]{strict: would\\it repeat?} & \shortstack[r]{strict: other\\tasks?} & pass\textasciicircum{}k & k & tasks & n & unscored \\
    \midrule
    openai:gpt-4o & vlm & 0.88 & 0.00 to 1.00 & 0.00 to 1.00 & 0.75 & 0.00 to 1.00 & 0.00 to 1.00 & 0.50 & 2 & 2 & 4 & 0 \\
    \textit{GPT-4o (paper)} & \textit{vlm} & \textit{1.00} & \textit{0.90 to 1.00} & \textit{0.22 to 1.00} & \textit{-- (a)} & \textit{-- (a)} & \textit{-- (a)} & \textit{-- (a)} & \textit{-- (a)} & \textit{2} & \textit{30} & \textit{-- (a)} \\
    \textit{Claude 3.5 Sonnet (paper)} & \textit{vlm} & \textit{1.00} & \textit{0.90 to 1.00} & \textit{0.22 to 1.00} & \textit{-- (a)} & \textit{-- (a)} & \textit{-- (a)} & \textit{-- (a)} & \textit{-- (a)} & \textit{2} & \textit{30} & \textit{-- (a)} \\
    \bottomrule
  \end{tabular}
\end{table}
"""
