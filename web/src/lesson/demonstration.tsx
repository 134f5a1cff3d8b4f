// An example: the reader says first what the robot will do, then both paths are there, and why the robot takes its own.
import type { ComponentChildren, JSX } from 'preact';
import { useState } from 'preact/hooks';
import type { Board, Path } from '../shared/board/types';
import { WorldName } from '../shared/play/board_pane';
import { Brackets } from '../shared/play/brackets';
import { Compare } from '../shared/play/compare';
import { RunsView, type Runs } from '../shared/play/runs';
import { SmallBoard } from '../shared/play/small_board';
import { t, withoutCells } from '../shared/texts';
import { choiceText } from './choice';
import { partingOf, playBoard, upperFirst, usePrinting, type Context } from './context';
import type { Demonstration, Sentence } from './document';
import { askingText, Guessing, type Guess } from './guess';
import { OutcomesView } from './outcomes';

// Sentences that can be said, each once: of some constraints nothing short is true.
export const textsOf = (sentences: Sentence[]): string[] =>
  [...new Set(sentences.map(({ text }) => text))].filter((text) => text !== '');

export function Sentences({ sentences }: { sentences: Sentence[] }): JSX.Element {
  return (
    <ul class="sentences">
      {textsOf(sentences).map((text) => (
        <li>{upperFirst(text)}.</li>
      ))}
    </ul>
  );
}

const kNothing: Guess = { mine: null, verdict: null };

export function DemonstrationView({ shown, number, name, ...context }: Context & { shown: Demonstration; number: number; name: string }) {
  const [guess, setGuess] = useState<Guess | null>(null);
  const isPrinting = usePrinting();
  const seen = guess ?? (isPrinting ? kNothing : null);
  const done = (made: Guess): void => {
    setGuess(made);
    context.tell(name, { shown, mine: made.mine, isRight: made.verdict?.isRight ?? false });
  };
  return (
    <article class="demonstration card">
      <h3>Example {number}</h3>
      {!seen && (
        <p class="question">
          {askingText(context, shown, `${shown.map ? 'Where will the robot go?' : 'What will the robot do?'} Show it first, then watch.`)}
        </p>
      )}
      <WorldName board={playBoard(context.domain, shown)} />
      {seen ? (
        <Seen {...context} shown={shown} guess={seen} isStill={isPrinting} />
      ) : (
        <Guessing {...context} shown={shown} submit={t('watch.sketched')} skip={t('watch.skip')} onGuess={done} />
      )}
    </article>
  );
}

// Both halves of "it would rather take 2 more steps than cross rubble: crossing rubble costs more than 2 steps".
function halvesOf(reason: string): [string, string] {
  const at = reason.indexOf(': ');
  return at < 0 ? [reason, ''] : [reason.slice(0, at), reason.slice(at + 2)];
}

function Seen({ shown, guess, isStill, ...context }: Context & { shown: Demonstration; guess: Guess; isStill: boolean }): JSX.Element {
  const { domain, legend } = context;
  const { mine, verdict } = guess;
  const board = playBoard(domain, shown);
  const isMine = mine !== null && verdict !== null && !verdict.isRight;
  const other = isMine ? mine : shown.alternative;
  const at = isMine ? partingOf(shown, mine) : (shown.decisive?.frame ?? null);
  // What one's own path overlooks is compared with it; what the board was chosen for, if it is something else, with the
  // path that shows it.
  const own = isMine && verdict.counts ? choiceText(context.lesson, shown.counts, verdict.counts) : '';
  const isSame = own !== '' && own === halvesOf(shown.reason)[0];
  const reason = (
    <>
      {mine && <p class={verdict?.isRight ? 'told right' : 'told wrong'}>{verdict?.isRight ? 'That is what it does.' : 'The robot does something else.'}</p>}
      <Reason reason={isMine && !isSame ? own : shown.reason} />
    </>
  );
  const rest = (
    <>
      {isMine && !isSame && <Besides {...context} shown={shown} />}
      <Brackets brackets={shown.brackets} />
      <More {...context} shown={shown} isOpen={isStill} />
    </>
  );
  if (shown.runs) {
    return (
      <RunsView
        board={board}
        legend={legend}
        shown={shown.runs}
        isStill={isStill}
        isOpen
        reason={reason}
        below={<OutcomesView {...context} shown={shown} mine={isMine ? mine : null} other={other} at={at} />}
      >
        {rest}
      </RunsView>
    );
  }
  return (
    <Compare
      board={board}
      legend={legend}
      robot={shown}
      other={other}
      otherName={isMine ? t('ledger.you') : 'Expected'}
      otherLine={isMine ? t('feedback.mine') : 'A path that one might have expected'}
      at={at}
      isStill={isStill}
      reason={reason}
    >
      {rest}
    </Compare>
  );
}

function Reason({ reason }: { reason: string }): JSX.Element | null {
  const [choice, conveyed] = halvesOf(reason);
  if (choice === '') return null;
  return (
    <div class="reasons">
      <p class="cost reason">{upperFirst(choice)}.</p>
      {conveyed !== '' && <p>{upperFirst(conveyed)}.</p>}
    </div>
  );
}

// The path that shows what the board was chosen for, beside the robot's.
function Besides({ shown, ...context }: Context & { shown: Demonstration }): JSX.Element {
  const { alternative: other } = shown;
  const at = shown.decisive?.frame ?? null;
  return (
    <div class="besides">
      <p class="list-title">And beside another path:</p>
      <Reason reason={shown.reason} />
      {shown.runs ? (
        <OutcomesView {...context} shown={shown} mine={null} other={other} at={at} />
      ) : (
        <figure class="small">
          <Whole {...context} board={shown} other={other} at={at} />
        </figure>
      )}
    </div>
  );
}

function More({ shown, isOpen, ...context }: Context & { shown: Demonstration; isOpen: boolean }): JSX.Element | null {
  const { flip } = shown;
  const hasMore = textsOf(shown.conveys).length > 1;
  if (!flip && !hasMore) return null;
  return (
    <Folded summary={t('feedback.why')} isOpen={isOpen}>
      {hasMore && <Sentences sentences={shown.conveys} />}
      {flip && (
        <figure class="small">
          <Whole {...context} board={flip} />
          <figcaption>On another map: {withoutCells(flip.text)}.</figcaption>
        </figure>
      )}
    </Folded>
  );
}

// Closed, its content is not there.
export function Folded({ summary, isOpen, children }: { summary: string; isOpen?: boolean; children: ComponentChildren }): JSX.Element {
  const [open, setOpen] = useState(false);
  const isShown = open || (isOpen ?? false);
  return (
    <details open={isShown} onToggle={(event) => setOpen(event.currentTarget.open)}>
      <summary>{summary}</summary>
      {isShown && children}
    </details>
  );
}

interface WholeProps extends Context {
  board: Board & { runs?: Runs | null };
  other?: Path | null;
  at?: number | null;
}

export function Whole({ board, domain, legend, ...rest }: WholeProps): JSX.Element {
  return <SmallBoard board={playBoard(domain, board)} legend={legend} path={board} runs={board.runs?.runs} {...(rest.other ? { other: rest.other, at: rest.at ?? null } : {})} />;
}
